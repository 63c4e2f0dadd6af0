#include "model/clip_library_file.hpp"
