// Scenes that can be touched, and the loop that does. The compiler of textures is apart: haptel/compiler.h.
#pragma once

#include <haptel/device.h>
#include <haptel/mesh.h>
#include <haptel/renderer.h>
#include <haptel/scene.h>
#include <haptel/servo.h>
#include <haptel/texture.h>
