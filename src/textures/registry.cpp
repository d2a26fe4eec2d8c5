#include "textures/texture_set.h"

#define KINDS FloatNode, float_texture, "textures/list.h"
#include "describe/register_kinds.inl"

#define KINDS SpectrumNode, spectrum_texture, "textures/list.h"
#include "describe/register_kinds.inl"
