// haptel_fuzz TARGET [--seconds N] [--seed N] [--runs N] [--keep FILE]: looks for findings
// haptel_fuzz TARGET --file FILE | --kept FILE: one input, as it is or as a run kept it
//
// A plain mutation loop, the same for the same seed, where libFuzzer is not at hand. The input of the moment is kept in
// a mapped file, so that it is there whatever happens to the process.
#include "tests/fuzz/target.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <random>
#include <sstream>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

using namespace haptel::fuzz;
using Clock = std::chrono::steady_clock;

constexpr size_t size_max = 64 * 1024;
constexpr time_t too_long_s = 60; // of the processor for one input, sanitized

struct Options {
    double seconds = 10;
    uint64_t seed = 1, runs = UINT64_MAX;
    std::string keep = "fuzz-input", kept, file;
};

// So many seconds of the processor from now on; 0: as many as it takes.
void allow(time_t seconds)
{
    const itimerval limit{{0, 0}, {seconds, 0}};
    setitimer(ITIMER_PROF, &limit, nullptr);
}

[[noreturn]] void misuse()
{
    std::fprintf(
        stderr,
        "usage: haptel_fuzz TARGET [--seconds N] [--seed N] [--runs N] [--keep FILE] [--file FILE] [--kept FILE]\n");
    for (const Target& target : targets())
        std::fprintf(stderr, "  %-10s %s\n", std::string(target.name).c_str(), std::string(target.about).c_str());
    std::exit(2);
}

Options options_from(int count, char** words)
{
    Options options;
    for (int i = 2; i < count; i += 2) {
        const std::string name = words[i];
        if (i + 1 == count) misuse();
        const char* value = words[i + 1];
        if (name == "--seconds")
            options.seconds = std::atof(value);
        else if (name == "--seed")
            options.seed = std::strtoull(value, nullptr, 10);
        else if (name == "--runs")
            options.runs = std::strtoull(value, nullptr, 10);
        else if (name == "--keep")
            options.keep = value;
        else if (name == "--kept")
            options.kept = value;
        else if (name == "--file")
            options.file = value;
        else
            misuse();
    }
    return options;
}

// The input of the moment, in a file that outlives the process: its first eight bytes are its size.
class Keeper {
public:
    explicit Keeper(const std::string& path)
    {
        const int file = open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0644);
        if (file < 0 || ftruncate(file, size_max + 8) != 0) return;
        void* const mapped = mmap(nullptr, size_max + 8, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        if (mapped != MAP_FAILED) place = static_cast<char*>(mapped);
        close(file);
    }
    void keep(std::string_view bytes)
    {
        if (!place) return;
        const uint64_t size = bytes.size();
        std::memcpy(place, &size, sizeof size);
        std::memcpy(place + sizeof size, bytes.data(), bytes.size());
    }

private:
    char* place = nullptr;
};

class Mutator {
public:
    Mutator(const std::vector<std::string>& texts, uint64_t seed) : corpus(texts), random(seed) {}

    std::string next()
    {
        std::string text = any_of_corpus();
        for (uint64_t changes = 1 + below(6); changes > 0; --changes) change(text);
        text.resize(std::min(text.size(), size_max));
        return text;
    }

private:
    const std::vector<std::string>& corpus;
    std::mt19937_64 random;

    uint64_t below(uint64_t limit) { return random() % limit; }
    const std::string& any_of_corpus() { return corpus[below(corpus.size())]; }

    // Begin of a word, so that what is cut and pasted are tokens more often than halves of them.
    static size_t word_at(const std::string& text, size_t at)
    {
        const auto is_word = [](char c) { return (c >= '0' && c <= '9') || (c | 32) >= 'a' || c == '_' || c == '.'; };
        while (at > 0 && at < text.size() && is_word(text[at]) && is_word(text[at - 1])) --at;
        return at;
    }

    std::string piece_of(const std::string& text, size_t longest)
    {
        const size_t begin = word_at(text, below(text.size() + 1));
        return text.substr(begin, word_at(text, std::min(text.size(), begin + 1 + below(longest))) - begin);
    }

    void change(std::string& text)
    {
        static const char* const pieces[] = {
            "(",     ")",      "{",       "}",      "[",        "]",         ";",           ",",
            "..",    "grad(",  "float ",  "vec3",   "int ",     "mat2(",     "for ",        "if (",
            "else ", "break;", "return ", "const ", "texture ", "import \"", "\" as ",      "_, ",
            "///",   "/*",     "@facts",  "0",      "1e308",    "-0.0",      "4294967295u", "2147483647",
            "/ 0.0", "p",      "= {",     "out ",   "detach(",  "\n",        "\xff",        "\xe2\x88\x92",
            "..",    "? ",     ": ",      "in ",    "%x",       "yield ",    "for %i",
        };
        const size_t at = below(text.size() + 1), length = std::min<size_t>(text.size() - at, 1 + below(20));
        switch (below(9)) {
        case 0: text.erase(at, length); break;
        case 1: text.insert(at, pieces[below(std::size(pieces))]); break;
        case 2: text.insert(word_at(text, at), pieces[below(std::size(pieces))]); break;
        case 3: // a piece of itself, or of another
        case 4: text.insert(word_at(text, at), piece_of(below(2) ? text : any_of_corpus(), 60)); break;
        case 5: { // another word in its place
            const std::string piece = piece_of(text, 12);
            text.replace(word_at(text, at), std::min(text.size() - word_at(text, at), piece.size()), piece);
            break;
        }
        case 6:
            if (at < text.size()) text[at] = static_cast<char>(below(4) ? 32 + below(95) : below(256));
            break;
        case 7: // many times the same
            if (length < 8 && below(8) == 0) {
                const std::string piece = text.substr(at, length);
                for (uint64_t times = below(600); times > 0; --times) text.insert(at, piece);
            }
            break;
        case 8: // another number
            for (size_t i = at; i < std::min(text.size(), at + 40); ++i)
                if (text[i] >= '0' && text[i] <= '9') {
                    text[i] = static_cast<char>('0' + below(10));
                    break;
                }
            break;
        }
    }
};

std::string contents_of(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

} // namespace

int main(int argument_count, char** arguments)
{
    if (argument_count < 2) misuse();
    const auto target = std::ranges::find(targets(), std::string_view(arguments[1]), &Target::name);
    if (target == targets().end()) misuse();
    const Options options = options_from(argument_count, arguments);
    if (!options.file.empty()) {
        target->run(contents_of(options.file));
        return 0;
    }
    if (!options.kept.empty()) { // what Keeper left: size, then bytes
        const std::string bytes = contents_of(options.kept);
        uint64_t size = 0;
        if (bytes.size() >= sizeof size) std::memcpy(&size, bytes.data(), sizeof size);
        target->run(std::string_view(bytes).substr(std::min<size_t>(sizeof size, bytes.size()), size));
        return 0;
    }
    const std::vector<std::string> corpus = target->takes_seeds ? std::vector<std::string>{} : target->corpus();
    for (const std::string& text : corpus) target->run(text); // as they are
    Mutator mutator(corpus, options.seed);
    Keeper keeper(options.keep);
    const Clock::time_point begin = Clock::now();
    const auto elapsed_s = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    uint64_t runs = 0;
    for (; runs < options.runs && elapsed_s() < options.seconds; ++runs) {
        uint64_t seed = options.seed * 1'000'000'007 + runs;
        const std::string bytes =
            target->takes_seeds ? std::string(reinterpret_cast<const char*>(&seed), sizeof seed) : mutator.next();
        keeper.keep(bytes);
        allow(too_long_s); // its end is the end of the process, with the input kept
        target->run(bytes);
    }
    allow(0);
    std::printf("%s: seed %llu, %llu inputs in %.1f s (%.0f /s), no finding; %s\n", arguments[1],
                static_cast<unsigned long long>(options.seed), static_cast<unsigned long long>(runs), elapsed_s(),
                static_cast<double>(runs) / elapsed_s(), figures().c_str());
    return 0;
}
