#include "film/film.h"
#include "film/filter.h"

namespace alhazen {

#define KIND(name) Kind<Film> name##_film();
#include "film/list.h"
#undef KIND
#define KIND(name) Kind<Filter> name##_filter();
#include "film/filter_list.h"
#undef KIND

const KindList<Film>& film_kinds() {
    static const KindList<Film> kinds{
#define KIND(name) name##_film(),
#include "film/list.h"
#undef KIND
    };
    return kinds;
}

const KindList<Filter>& filter_kinds() {
    static const KindList<Filter> kinds{
#define KIND(name) name##_filter(),
#include "film/filter_list.h"
#undef KIND
    };
    return kinds;
}

} // namespace alhazen
