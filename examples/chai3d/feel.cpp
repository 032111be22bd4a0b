// feel [SECONDS]: a ball with waves in CHAI3D, on the first haptic device that it finds.
#include <textured_effect.h>

#include <waves.h> // made of ../library/waves.haptel by haptel_add_textures

#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int count, char** arguments)
{
    const double seconds = count > 1 ? std::atof(arguments[1]) : 30;
    chai3d::cHapticDeviceHandler devices;
    chai3d::cGenericHapticDevicePtr device;
    if (!devices.getDevice(device, 0)) return std::fputs("no haptic device\n", stderr), 1;

    haptel_block_waves values = haptel_defaults_waves;
    values.depth = 100e-6;
    chai3d::cWorld world;
    auto* ball = new chai3d::cShapeSphere(0.04); // metres; the world deletes what is its child
    world.addChild(ball);
    ball->m_material->setStiffness(500);
    ball->addEffect(new TexturedEffect(ball, haptel_texture_waves, values, values.depth));

    auto* tool = new chai3d::cToolCursor(&world);
    world.addChild(tool);
    tool->setHapticDevice(device);
    tool->setWorkspaceRadius(0.1);
    tool->setRadius(0);
    tool->setWaitForSmallForce(true);
    if (!tool->start()) return std::fputs("the device does not start\n", stderr), 1;
    double largest_n = 0;
    chai3d::cPrecisionClock clock;
    clock.start();
    while (clock.getCurrentTimeSeconds() < seconds) {
        world.computeGlobalPositions(true);
        tool->updateFromDevice();
        tool->computeInteractionForces();
        tool->applyToDevice();
        largest_n = std::fmax(largest_n, tool->getDeviceGlobalForce().length());
    }
    tool->stop();
    std::printf("at most %.2f N\n", largest_n);
}
