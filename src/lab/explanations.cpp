/// What the methods do, for those who see them for the first time.
#include "lab/report.h"

namespace alhazen {

namespace {

struct Explanation {
    std::string_view name, text;
};

constexpr Explanation builders[] = {
    {"sah",
     "From the top down: each box of triangles is cut in two where the expected cost of a random ray is "
     "least. "
     "A ray meets a box with a chance in proportion to the box's surface, so the cost of a cut is the "
     "surface "
     "of each half times the triangles in it: the surface area heuristic. Instead of every cut, some dozen "
     "planes across the box are compared (bins). Good trees at a moderate price."},
    {"sbvh",
     "Like sah, but a triangle that lies across a cut may be cut as well and stand in both halves, where "
     "that "
     "pays. Long, slanted triangles no longer blow up the boxes of their neighbours; the price is time to "
     "build and some triangles that are stored more than once."},
    {"lbvh",
     "Every triangle's centre gets a number whose bits take turns between x, y and z (its Morton code). "
     "Sorted by that number, neighbours in the list are neighbours in space, and where the leading bits of "
     "the numbers change, a node ends. Each node finds its own range without asking any other, so all are "
     "built at the same time. The fastest to build; the tree never looked at a surface."},
    {"octree",
     "Space is halved along x, y and z at once, again and again: eight cells a cell. The cells are read off "
     "the same sorted Morton codes, three bits a level. Here each cell's box is shrunk to its triangles, and "
     "the eight children become three levels of a binary tree."},
    {"kdtree",
     "Space is halved along one axis after another, always in the middle, as the bits of Morton codes do. "
     "Triangles that reach across a plane stand on both sides, cut there, so the two halves never overlap. "
     "A tree of space rather than of things."},
    {"ploc",
     "From the bottom up: the triangles are sorted along a curve through space, each looks a few places to "
     "the left and right for the partner with which it makes the smallest box, and all pairs that chose each "
     "other become nodes. Repeated until one is left. Nearly the quality of sah, and every step is "
     "parallel."},
};

constexpr Explanation walks[] = {
    {"stack",
     "Two children a node. Of the children that the ray meets it goes to the nearer and writes the farther "
     "on "
     "a stack; when there is nothing left below, it takes the top of the stack. The textbook's walk, and "
     "what the others are measured by."},
    {"guthe",
     "Four children a node, and several rays at a time in one thread. Each does a step and asks memory for "
     "what it will need next; while that is on its way the others do theirs. Made for graphics processors, "
     "which hide waiting in the same way with thousands of threads."},
    {"stackless",
     "No stack at all: a word of bits, one a level, remembers where the farther child is still to be "
     "visited. The lowest set bit says how far to go back up, and the path's number is looked up in a "
     "hash table without collisions, which leads to the node in one step."},
    {"cwbvh",
     "Eight children a node in 80 bytes: the children's boxes are stored in bytes, as fractions of the "
     "node's "
     "own box. They are a little too large, so some are visited in vain, but five times as many fit into "
     "the cache. Children stand in an order that suits each of the eight directions a ray can have."},
    {"shortstack",
     "A stack of a few entries only. When it overflows, the oldest entries are forgotten; when it is "
     "empty, the ray begins again at the root, and a trail of small numbers, one a level, says which "
     "children are done already."},
    {"wide",
     "Eight children a node, whose boxes are tested by one instruction each way, and sixteen rays in flight "
     "in a thread: each does a step, asks memory for what comes next, and lets the others go on. A single "
     "ray waits most of its time, for memory and for branches that were guessed wrong; sixteen fill each "
     "other's pauses. What Alhazen renders with."},
};

template <std::size_t n>
std::string_view find(const Explanation (&list)[n], std::string_view name) {
    for (const Explanation& e : list)
        if (e.name == name) return e.text;
    return "";
}

template <class Entry>
std::string_view about(std::span<const Entry> list, std::string_view name) {
    for (const Entry& e : list)
        if (e.name == name) return e.about;
    return "";
}

} // namespace

std::string explain_builder(std::string_view name) {
    std::size_t plus = name.find('+');
    std::string_view plain = name.substr(0, plus);
    std::string_view text = find(builders, plain);
    std::string out(text.empty() ? about(accel_builders(), plain) : text);
    if (plus != std::string_view::npos)
        out += " Afterwards nodes whose box is large for what it holds are taken out and put back where they "
               "make "
               "the tree cheapest (reinsertion).";
    return out;
}

std::string explain_walk(std::string_view name) {
    std::string_view text = find(walks, name);
    return std::string(text.empty() ? about(accel_walks(), name) : text);
}

} // namespace alhazen
