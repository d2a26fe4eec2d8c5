#include "samplers/sampler.h"

#define KINDS Sampler, sampler, "samplers/list.h"
#include "describe/register_kinds.inl"
