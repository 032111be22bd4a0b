// A ball of stone, felt by a simulated hand, whose grain grows deeper under it.
#include <haptel/compiler.h>
#include <haptel/haptel.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

int main(int count, char** arguments)
{
    const std::string texture = count > 1 ? arguments[1] : "stone.haptel:stone";
    haptel::SceneBuilder build{haptel::compiler()};
    auto ball =
        build.add(haptel::icosphere(0.10), {.stiffness_n_per_m = 800, .static_friction = 0.3, .dynamic_friction = 0.2});
    ball.texture(texture, {{"depth", "60um"}});
    const auto scene = build.finish({.rate_hz = 1000, .force_limit_n = 7});
    std::fputs(scene.messages().c_str(), stderr);
    if (!scene) return 1;

    haptel::Servo servo{scene, haptel::open_device("simulated:premium"), {.seconds = 1}};
    if (!servo) return std::fputs(servo.messages().c_str(), stderr), 1;
    servo.start();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const std::string refused = ball.set("depth", "80um"); // felt within two ticks
    if (!refused.empty()) return std::fputs(refused.c_str(), stderr), 1;
    const haptel::Report report = servo.wait();
    std::printf("%llu ticks, %llu of them in contact, at most %.2f N, %llu changes of texture\n",
                static_cast<unsigned long long>(report.ticks), static_cast<unsigned long long>(report.contact_ticks),
                report.force_max_n, static_cast<unsigned long long>(report.textures_changed));
    return report.faulted || report.textures_changed != 1 ? 1 : 0;
}
