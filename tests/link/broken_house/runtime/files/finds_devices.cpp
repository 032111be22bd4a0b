#include "device/registry.h"
#include <assimp/Importer.hpp>
