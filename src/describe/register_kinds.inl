/// Makes a family's KindList of its list.h. A file that includes this first defines
///     #define KINDS Family, word, "room/list.h"
/// and gets, for a line KIND(name) of the list, a call of Kind<Family> name_word(), and for all of them
/// const KindList<Family>& word_kinds(). The list is read twice, so it can be no macro of its own. May be
/// included again for another family.
#define KINDS_FAMILY_OF(family, word, list) family
#define KINDS_LIST_OF(family, word, list) list
#define KINDS_MAKER_OF(family, word, list, name) Kind<family> name##_##word()
#define KINDS_CALL_OF(family, word, list, name) name##_##word()
#define KINDS_GETTER_OF(family, word, list) word##_kinds()
// Lets KINDS become three arguments first.
#define KINDS_APPLY(macro, ...) macro(__VA_ARGS__)

namespace alhazen {

#define KIND(name) KINDS_APPLY(KINDS_MAKER_OF, KINDS, name);
#include KINDS_APPLY(KINDS_LIST_OF, KINDS)
#undef KIND

const KindList<KINDS_APPLY(KINDS_FAMILY_OF, KINDS)>& KINDS_APPLY(KINDS_GETTER_OF, KINDS) {
    static const KindList<KINDS_APPLY(KINDS_FAMILY_OF, KINDS)> kinds{
#define KIND(name) KINDS_APPLY(KINDS_CALL_OF, KINDS, name),
#include KINDS_APPLY(KINDS_LIST_OF, KINDS)
#undef KIND
    };
    return kinds;
}

} // namespace alhazen

#undef KINDS
#undef KINDS_APPLY
#undef KINDS_GETTER_OF
#undef KINDS_CALL_OF
#undef KINDS_MAKER_OF
#undef KINDS_LIST_OF
#undef KINDS_FAMILY_OF
