#include <alsa/asoundlib.h>
#include <sndfile.h>
