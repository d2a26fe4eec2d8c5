#include "shapes/shape.h"

#define KINDS Shape, shape, "shapes/list.h"
#include "describe/register_kinds.inl"
