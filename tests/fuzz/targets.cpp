#include "tests/fuzz/target.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace haptel::fuzz {
namespace {

constexpr Target all[] = {
    {"parse", "lexer and parser on bytes", false, haptel_corpus, parse_text},
    {"compile", "checker, lowering and analysis on bytes", false, haptel_corpus, compile_text},
    {"format", "the formatter: stable, and true to the meaning", false, haptel_corpus, format_text},
    {"ir", "reader of IR text, verifier, printer, interpreter", false, ir_corpus, read_ir},
    {"picture", "readers of pictures on bytes", false, picture_corpus, read_picture},
    {"mesh", "readers of meshes on bytes, and the surface that is made of them", false, mesh_corpus, read_mesh},
    {"falcon", "what a Falcon sends, and its program's file", false, falcon_corpus, hear_falcon},
    {"hid", "what a HID device says of its reports", false, hid_corpus, read_hid},
    {"inverse3", "what the service of the Inverse3 says", false, inverse3_corpus, hear_inverse3},
    {"osc", "messages of other programs that control an exploration", false, osc_corpus, hear_osc},
    {"recording", "readers of recorded runs on bytes, and what they read written again", false, recording_corpus,
     read_recording},
    {"library", "archives of texture libraries, their manifests and locks", false, library_corpus, read_library},
    {"programs", "random programs: interpreter, 113-bit oracle and machine code", true, nullptr, run_program},
    {"bounds", "random programs: what is measured lies in the bounds", true, nullptr, bound_program},
};

std::array<std::pair<const char*, uint64_t>, 16> counters{};

} // namespace

std::span<const Target> targets()
{
    return all;
}

void count(const char* what, uint64_t how_many)
{
    for (auto& [name, number] : counters) {
        if (name && std::strcmp(name, what) != 0) continue;
        name = what;
        number += how_many;
        return;
    }
}

std::string figures()
{
    std::string text;
    for (const auto& [name, number] : counters)
        if (name) text += (text.empty() ? "" : ", ") + std::to_string(number) + " " + name;
    return text;
}

void fail(const std::string& what)
{
    std::fprintf(stderr, "\nfuzz: %s\n", what.c_str());
    std::abort();
}

} // namespace haptel::fuzz
