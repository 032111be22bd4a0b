// What is fuzzed: each target takes any bytes and must come back, soon, having found everything in order.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::fuzz {

struct Target {
    std::string_view name, about;
    bool takes_seeds;                     // the bytes are a seed: there is nothing to mutate
    std::vector<std::string> (*corpus)(); // what mutation starts from
    void (*run)(std::string_view bytes);
};

std::span<const Target> targets();

// Figures of a target since the start, "programs 1000, points 8000"; empty if there are none.
std::string figures();
void count(const char* what, uint64_t how_many = 1);

// A finding: says so and ends the process, so that the input can be kept.
[[noreturn]] void fail(const std::string& what);

// text_targets.cpp, falcon_target.cpp, hid_target.cpp, inverse3_target.cpp, osc_target.cpp, picture_target.cpp,
// mesh_target.cpp, recording_target.cpp, library_target.cpp, program_targets.cpp
void parse_text(std::string_view bytes);
void compile_text(std::string_view bytes);
void format_text(std::string_view bytes);
void read_ir(std::string_view bytes);
void hear_falcon(std::string_view bytes);
void read_hid(std::string_view bytes);
void hear_inverse3(std::string_view bytes);
void hear_osc(std::string_view bytes);
void read_picture(std::string_view bytes);
void read_mesh(std::string_view bytes);
void read_recording(std::string_view bytes);
void read_library(std::string_view bytes);
void run_program(std::string_view bytes);
void bound_program(std::string_view bytes);
std::vector<std::string> haptel_corpus();
std::vector<std::string> ir_corpus();
std::vector<std::string> falcon_corpus();
std::vector<std::string> hid_corpus();
std::vector<std::string> inverse3_corpus();
std::vector<std::string> osc_corpus();
std::vector<std::string> picture_corpus();
std::vector<std::string> mesh_corpus();
std::vector<std::string> recording_corpus();
std::vector<std::string> library_corpus();

} // namespace haptel::fuzz
