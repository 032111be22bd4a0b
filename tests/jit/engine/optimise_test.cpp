// Quick code becomes fast code in the background: the same pointers, the same bits, at any moment.
#include "jit/texture/background_optimiser.h"
#include "jit/texture/resolver.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <thread>

using namespace haptel;
using namespace std::chrono_literals;
using test::request_over;

namespace {

const std::string text = "texture t(float depth = 1mm) { return depth * fbm(p / 3mm, 6) * sinturn(p.x / 7mm); }\n";

std::vector<haptel_sample> samples_of(const TextureBinding& binding)
{
    std::vector<haptel_sample> all;
    for (int i = 0; i < 50; ++i) all.push_back(test::sample_at(binding, {i * 1.37e-3, i * -2.11e-3, 4e-3}));
    return all;
}

// Of what the texture gives: bytes between the members are nobody's.
bool same_bits(const std::vector<haptel_sample>& a, const std::vector<haptel_sample>& b)
{
    return std::ranges::equal(a, b, [](const haptel_sample& one, const haptel_sample& other) {
        return std::memcmp(&one, &other, offsetof(haptel_sample, stiffness_scale)) == 0 && one.faults == other.faults;
    });
}

} // namespace

TEST_CASE("a caller in another thread holds its pointer while the code behind it is replaced, and sees no other bit")
{
    jit::TextureOptions pictures;
    pictures.entries = jit::Entries::both_and_batches;
    for (jit::TextureOptions options : {jit::servo_options(), pictures}) {
        options.kernels = false; // never from disk: not of full effort for certain
        const jit::CompiledTextures made = jit::compile_texture(text, options);
        REQUIRE(made.program);
        const TextureResult bound = jit::make_binding(made.program, "t", request_over(0.1));
        REQUIRE(bound.binding);
        CHECK_FALSE(made.program->is_optimised());
        const haptel_texture before = *bound.binding->texture;
        const std::vector<haptel_sample> expected = samples_of(*bound.binding);

        std::atomic<bool> done{false};
        std::atomic<size_t> calls{0}, different{0};
        std::thread servo([&] {
            while (!done || calls < 100) {
                different += !same_bits(samples_of(*bound.binding), expected);
                ++calls;
            }
        });
        made.program->optimise();
        made.program->optimise(); // nothing is left to do
        done = true;
        servo.join();
        CHECK(made.program->is_optimised());
        CHECK(different == 0);
        CHECK(same_bits(samples_of(*bound.binding), expected));
        CHECK(bound.binding->texture->height_gradient == before.height_gradient);
    }
}

TEST_CASE("replaced code goes with its program")
{
    REQUIRE(test::programs_fall_to(0)); // those of the tests before
    {
        jit::TextureOptions options;
        options.kernels = false;
        const jit::CompiledTextures made = jit::compile_texture(text, options);
        CHECK(jit::programs_alive() == 1);
        made.program->optimise();
        CHECK(jit::programs_alive() == 2);
    }
    CHECK(test::programs_fall_to(0));
}

TEST_CASE("what a scene loads is optimised without being asked for, and the newest edit first")
{
    const test::Folder folder;
    jit::ProgramCache cache;
    // A constant that no other run has had: no code on disk.
    const auto unique = [](int i) {
        return "texture t() { return 1um * (fbm(p / 1mm, 3) + 0.5 * perlin(p / 1mm) + " + std::to_string(getpid()) +
               "." + std::to_string(i) + "); }\n";
    };
    folder.write("t.haptel", unique(1));
    const auto first = cache.load(folder.file("t.haptel"));
    folder.write("t.haptel", unique(2));
    const auto second = cache.load(folder.file("t.haptel"));
    REQUIRE((first->program && second->program && first != second));
    for (int i = 0; i < 2000 && !(first->program->is_optimised() && second->program->is_optimised()); ++i)
        std::this_thread::sleep_for(10ms);
    CHECK(first->program->is_optimised()); // somebody holds it still
    CHECK(second->program->is_optimised());
}

TEST_CASE("the thread that optimises ends with the last binding: LLVM's own objects go when the process does")
{
    const test::Folder folder;
    folder.write("t.haptel", "texture t() { return 1um * fbm(p / 1mm, 3) + " + std::to_string(getpid()) + "um; }\n");
    std::weak_ptr<jit::BackgroundOptimiser> thread;
    {
        const auto cache = std::make_shared<jit::ProgramCache>();
        TextureRequest request = request_over(0.1);
        request.reference = folder.file("t.haptel");
        const TextureResult bound = jit::make_resolver(cache)(request); // the resolver goes at once
        REQUIRE(bound.binding);
        thread = jit::BackgroundOptimiser::shared();
        CHECK_FALSE(thread.expired()); // the binding owns it
        const auto program = cache->known(folder.file("t.haptel"))->program;
        for (int i = 0; i < 2000 && !program->is_optimised(); ++i) std::this_thread::sleep_for(10ms);
        CHECK(program->is_optimised());
        CHECK_FALSE(thread.expired());
    }
    CHECK(thread.expired());
}
