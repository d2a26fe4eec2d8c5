#include "cameras/camera.h"

#define KINDS Camera, camera, "cameras/list.h"
#include "describe/register_kinds.inl"
