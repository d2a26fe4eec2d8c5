#include "integrators/integrator.h"

#define KINDS Integrator, integrator, "integrators/list.h"
#include "describe/register_kinds.inl"
