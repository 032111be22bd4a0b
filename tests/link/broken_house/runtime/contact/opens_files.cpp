#include "runtime/files/scene_file.h"
#  include <toml++/toml.h>
