#include "materials/material.h"

#define KINDS Material, material, "materials/list.h"
#include "describe/register_kinds.inl"
