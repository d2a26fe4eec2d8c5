#include "sdf/sdf.h"

#define KINDS Sdf, sdf, "sdf/list.h"
#include "describe/register_kinds.inl"
