#include "film/film.h"
#include "film/filter.h"

#define KINDS Film, film, "film/list.h"
#include "describe/register_kinds.inl"

#define KINDS Filter, filter, "film/filter_list.h"
#include "describe/register_kinds.inl"
