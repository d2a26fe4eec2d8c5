#include "media/medium.h"

#define KINDS Medium, medium, "media/list.h"
#include "describe/register_kinds.inl"
