// Texture files that are edited all the time, well and badly, while a servo feels them.
#include "tests/tools/commands/live_stage.h"
#include "tests/tools/commands/quiet_machine.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <random>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

using namespace haptel;
using namespace haptel::test;

namespace {

std::string texture_of(const std::string& height)
{
    return "import \"part.haptel\";\ntexture t(float depth = 60um in 0um .. 200um) { return " + height + "; }\n";
}

// Edits as people, editors and accidents make them, the same for the same seed.
class Editor {
public:
    Editor(const Folder& folder, uint64_t seed) : folder_(folder), random_(seed) { mend(); }

    void edit()
    {
        mend_names();
        switch (random_() % 10) {
        case 0: folder_.write("t.haptel", good()); break;
        case 1: folder_.replace("t.haptel", good()); break;
        case 2: folder_.write("t.haptel", broken()); break;
        case 3: folder_.replace("t.haptel", broken()); break;
        case 4: { // half of it, and the rest with a later edit or never
            const std::string text = good();
            folder_.write("t.haptel", std::string_view(text).substr(0, random_() % text.size()));
            break;
        }
        case 5: std::filesystem::rename(folder_.file("t.haptel"), folder_.file("away.haptel")); break;
        case 6: // restored by the next
            std::filesystem::remove(folder_.file("t.haptel"));
            break;
        case 7: folder_.write("part.haptel", "float part() { return " + micrometres() + "; }\n"); break;
        case 8: // what it imports is gone, or is something else
            if (random_() % 2)
                std::filesystem::remove(folder_.file("part.haptel"));
            else
                folder_.write("part.haptel", "float other() { return 1um; }\n");
            break;
        case 9: // another import, which may not be there
            folder_.write("other.haptel", "float part() { return " + micrometres() + "; }\n");
            folder_.replace("t.haptel", "import \"" + std::string(random_() % 3 ? "other" : "none") +
                                            ".haptel\";\ntexture t() { return part(); }\n");
            break;
        }
    }

    // All in order again; returns nothing but what is felt then is `depth` micrometres high.
    void mend(double depth_um = 60)
    {
        mend_names();
        folder_.write("part.haptel", "float part() { return 1um; }\n");
        folder_.replace("t.haptel", "import \"part.haptel\";\ntexture t(float depth = " + std::to_string(depth_um) +
                                        "um in 0um .. 200um) { return depth + 0.0 * part(); }\n");
    }

private:
    uint64_t below(uint64_t limit) { return random_() % limit; }
    std::string micrometres() { return std::to_string(below(200)) + "um"; }
    std::string good()
    {
        const char* const heights[] = {"depth * sinturn(p.x / 2mm)", "min(depth, part())",
                                       "0.5 * (depth + part()) * perlin(p / 3mm)", "part()"};
        return texture_of(heights[below(std::size(heights))]) + "// " + std::to_string(below(1000)) + "\n";
    }
    std::string broken()
    {
        const char* const texts[] = {"texture t() { return",
                                     "texture u() { return 1mm; }",
                                     "texture t() { return 1.0 / 0.0 * dept; }",
                                     "texture t(int n = 3) { while (n > 0) {} return 1mm; }",
                                     "",
                                     "\xff\xfe\0"};
        return texts[below(std::size(texts))];
    }
    void mend_names() // of what was moved or removed by the last edit
    {
        std::error_code was_there;
        std::filesystem::rename(folder_.file("away.haptel"), folder_.file("t.haptel"), was_there);
        if (!std::filesystem::exists(folder_.file("t.haptel"))) folder_.write("t.haptel", good());
    }

    const Folder& folder_;
    std::mt19937_64 random_;
};

// The same edits of a texture that nobody feels, compiled by another process.
class EditsElsewhere {
public:
    EditsElsewhere()
    {
        std::signal(SIGPIPE, SIG_IGN);
        REQUIRE(pipe2(ends_, O_CLOEXEC) == 0);
        process_ = fork();
        REQUIRE(process_ >= 0);
        close(ends_[process_ > 0 ? 0 : 1]);
        if (process_ > 0) return;
        try {
            _exit(compile_until_closed() > 0 ? 0 : 1);
        } catch (...) {
            _exit(2);
        }
    }
    ~EditsElsewhere()
    {
        int status = 0;
        close(ends_[1]), waitpid(process_, &status, 0);
        CHECK(status == 0); // it compiled some
    }

    void edit() const { CHECK(write(ends_[1], "e", 1) == 1); }

private:
    uint64_t compile_until_closed() const
    {
        LiveStage stage("texture t() { return 60um; }\n");
        Editor editor(stage.folder, 3);
        for (char one = 0; read(ends_[0], &one, 1) == 1; stage.textures.take_messages()) editor.edit();
        return stage.textures.compiled();
    }

    int ends_[2] = {};
    pid_t process_ = 0;
};

// Of the edits, of those elsewhere, and of none.
std::vector<Deadlines> edit_while_it_is_felt(int times)
{
    const EditsElsewhere elsewhere;
    LiveStage stage("texture t() { return 60um; }\n");
    Editor editor(stage.folder, 3);
    std::mt19937_64 random(4);
    std::size_t said = 0;
    const uint64_t serial = stage.slot().newest_serial();
    const auto pause = [&] { std::this_thread::sleep_for(std::chrono::milliseconds(random() % 40)); };
    LiveRun edited = LiveRun::of(stage, times,
                                 [&](int) {
                                     editor.edit();
                                     pause();
                                     said += stage.textures.take_messages().size();
                                 },
                                 {[&](int) {
                                      elsewhere.edit();
                                      pause();
                                  },
                                  [&](int) { pause(); }});
    const auto told = [&](std::size_t turn) {
        return fmt::format("{:.2f} +- {:.2f}", edited.deadlines[turn].mean(), edited.deadlines[turn].error());
    };
    WARN("of 1000 deadlines missed: " << told(0) << ", while another process compiles " << told(1)
                                      << ", while nothing is edited " << told(2) << "; " << stage.textures.compiled()
                                      << " compiled, " << stage.slot().newest_serial() - serial << " felt; force "
                                      << edited.force_min_n << " .. " << edited.force_max_n << " N, largest step "
                                      << edited.step_max_n << " N in a period; heap grew by " << edited.heap_growth
                                      << " bytes, resident by " << edited.resident_growth);
    CHECK(edited.report.state == runtime::ServoState::stopped);
    CHECK(edited.report.allocations_in_tick == 0);
    CHECK(edited.report.faults == 0);
    CHECK(stage.slot().newest_serial() - serial > static_cast<uint64_t>(times) / 40);
    CHECK(said > 0);
    CHECK(edited.force_max_n - edited.force_min_n > 0.02);
    CHECK(edited.step_max_n < 2 * edited.force_max_n / 50);
    CHECK(edited.heap_growth < 1 << 20);
    CHECK(edited.resident_growth < 64 << 20);

    editor.mend(123); // and what is saved last is what is felt
    CHECK(comes_true([&] {
        const auto parameters = stage.textures.controlled()[0].parameters;
        return parameters.size() == 1 && std::abs(parameters[0].second - 123e-6) < 1e-12;
    }));
    return std::move(edited.deadlines);
}

} // namespace

TEST_CASE("edits of texture files while a servo runs: no allocation, no step of the force, no memory")
{
    edit_while_it_is_felt(400);
}

TEST_CASE("the same of 10 000 edits, which miss no deadline that a servo does not miss without them", "[.long]")
{
    const ProcessorsAwake awake;
    const FilesInMemory in_memory;
    const std::vector<Deadlines> deadlines = edit_while_it_is_felt(10'000);
    for (std::size_t other = 1; other < deadlines.size(); ++other) {
        INFO(other);
        CHECK(deadlines[0].mean() - deadlines[other].mean() <
              3 * std::hypot(deadlines[0].error(), deadlines[other].error()));
    }
}
