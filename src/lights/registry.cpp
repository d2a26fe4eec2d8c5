#include "lights/area_light.h"
#include "lights/light.h"

#define KINDS Light, light, "lights/list.h"
#include "describe/register_kinds.inl"

#define KINDS AreaLight, area_light, "lights/area_list.h"
#include "describe/register_kinds.inl"
