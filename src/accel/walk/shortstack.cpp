/// A walk through wide nodes with a stack of a few entries: Vaidyanathan, Woop and Benthin 2019, "Wide BVH
/// Traversal with a Short Stack" (Laine 2010, "Restart Trail for Stackless BVH Traversal", for binary nodes).
///
/// The stack is a ring: when it is full, the oldest entry, the one needed last, is forgotten. To find such
/// children again the walk keeps a trail: a level of the path from the root, how many of the node's children
/// are behind it, or `all` when it is at the last. When the stack is empty and the trail says that something
/// is left, the walk starts again at the root and goes down past the children that the trail counts. That
/// needs each node's children in the same order on every visit: sorted by entry, of equal entries by place.
/// A hit found meanwhile shortens the ray, but that only takes children off the far end.
///
/// Nodes are the compressed ones of eight children that the article has in mind (Ylitie, Karras and Laine
/// 2017, see layout/compressed.h), and so are entries: 32 bits for the parent's number, the child's slot in
/// it, and whether it is the last of its parent's, which sets the trail to `all` when it is taken, so that
/// levels that are done are skipped at once. The article's extension, not to test a leaf that lies behind a
/// hit found since it was pushed, is here a second test of the leaf's box, to which its entry leads.
///
/// On a GPU, or in a circuit, the stack is the scarce thing, and five entries come close to a full stack. A
/// CPU has room for full stacks: there, this costs the trail and the restarts and saves nothing but memory;
/// it is of use for measuring how few entries a walk needs.
#include "accel/list.h"
#include "accel/walk/compressed_structure.h"
#include "accel/walk/compressed_test.h"

namespace alhazen {

namespace {

constexpr int width = CompressedNode::slots;
constexpr int max_entries = 64;

struct ShortStackLayout {
    CompressedLayout compressed;
    int stack_entries;

    LayoutStats stats() const { return compressed.stats(); }
};

struct Entry {
    std::uint32_t is_last : 1, slot : 3, parent : 28;
};
static_assert(sizeof(Entry) == 4);

/// What stands in a slot: a node, or primitives.
struct Child {
    std::uint32_t index; ///< a node's number, or the first primitive
    std::uint32_t count; ///< of primitives; 0 for a node

    bool is_leaf() const { return count > 0; }
    static Child of(const CompressedNode& node, int slot) {
        if (node.is_inner(slot)) return {node.child(slot), 0};
        const std::uint32_t meta = node.meta[slot];
        return {node.first_primitive + (meta & 31), static_cast<std::uint32_t>(std::popcount(meta >> 5))};
    }
};

/// The slots that are hit, nearest first, of equally near ones the first. That order depends on the node and
/// the ray only: a smaller tmax takes slots off the end.
struct Hits {
    int count = 0;
    struct Hit {
        float t;
        int slot;
    } list[width];

    Hits(const CompressedTest& test, const CompressedNode& node, float tmax) {
        for (int first = 0; first < width; first += 4) {
            const auto four = test(node, first, tmax);
            for (int i = 0; i < 4; ++i)
                if (four.is_hit[i] && node.meta[first + i] != 0) insert(four.entry[i], first + i);
        }
    }

  private:
    void insert(float t, int slot) {
        int i = count++;
        for (; i > 0 && list[i - 1].t > t; --i) list[i] = list[i - 1];
        list[i] = {t, slot};
    }
};

/// The last few entries that were pushed.
class Ring {
  public:
    explicit Ring(int capacity) : capacity_(capacity) {}

    bool empty() const { return size_ == 0; }
    int size() const { return size_; }
    void push(Entry entry) {
        entries_[top_] = entry;
        top_ = top_ + 1 == capacity_ ? 0 : top_ + 1;
        size_ = std::min(size_ + 1, capacity_);
    }
    Entry pop() {
        top_ = top_ == 0 ? capacity_ - 1 : top_ - 1;
        --size_;
        return entries_[top_];
    }

  private:
    Entry entries_[max_entries];
    int capacity_, top_ = 0, size_ = 0;
};

/// How far the children of each node on the path from the root are done.
class Trail {
  public:
    static constexpr std::uint8_t all = width;

    std::uint8_t done(int level) const { return done_[level]; }
    void set_all(int level) { done_[level] = all; }
    /// The deepest level above this one that has children left, with one more of them counted; -1: none.
    int advance(int level) {
        do done_[level--] = 0;
        while (level >= 0 && done_[level] == all);
        if (level >= 0) ++done_[level];
        return level;
    }

  private:
    std::uint8_t done_[CollapsedTree::max_depth + 1] = {};
};

struct ShortStackWalk {
    using Layout = ShortStackLayout;

    template <Query query, class Counter>
    static void walk(const Layout& layout, const BoxRay& ray, Nearest<query>& nearest, Counter& counter) {
        const CompressedTest test(ray);
        Ring stack(layout.stack_entries);
        Trail trail;
        Child current{0, 0};
        int level = 0; // of current
        for (;;) {
            if (current.is_leaf()) {
                counter.leaf();
                if (nearest.test(current.index, current.count)) return;
            } else {
                counter.node();
                const CompressedNode& node = layout.compressed.nodes[current.index];
                const Hits hits(test, node, nearest.tmax());
                int first = trail.done(level);
                if (first == Trail::all) first = std::max(hits.count - 1, 0);
                if (first < hits.count) {
                    if (first == hits.count - 1) trail.set_all(level);
                    for (int i = hits.count - 1; i > first; --i) {
                        const auto slot = static_cast<std::uint32_t>(hits.list[i].slot);
                        stack.push({i == hits.count - 1, slot & 7, current.index & 0xfffffff});
                    }
                    counter.stack(stack.size());
                    current = Child::of(node, hits.list[first].slot);
                    ++level;
                    continue;
                }
            }
            if (!next(layout, test, nearest.tmax(), stack, trail, level, current, counter)) return;
        }
    }

  private:
    /// Takes the next child off the stack, or goes back to the root to look for it; false: all is done.
    template <class Counter>
    static bool next(const Layout& layout, const CompressedTest& test, float tmax, Ring& stack, Trail& trail,
                     int& level, Child& current, Counter& counter) {
        for (;;) {
            const int parent = trail.advance(level);
            if (parent < 0) return false;
            if (stack.empty()) {
                counter.restart();
                level = 0;
                current = {0, 0};
                return true;
            }
            const Entry entry = stack.pop();
            if (entry.is_last) trail.set_all(parent);
            level = parent + 1;
            const CompressedNode& node = layout.compressed.nodes[entry.parent];
            current = Child::of(node, entry.slot);
            if (!current.is_leaf() || test(node, entry.slot & 4, tmax).is_hit[entry.slot & 3]) return true;
        }
    }
};

std::unique_ptr<Structure> make(const Primitives& primitives, const Tree& tree, const WalkOptions& options) {
    return make_compressed<ShortStackWalk>(primitives, tree,
                                           std::clamp(options.stack_entries, 1, max_entries));
}

} // namespace

AccelWalk shortstack_walk() {
    return {"shortstack",
            "nodes of 8, a stack of a few entries and a restart trail (Vaidyanathan, Woop and Benthin 2019)",
            {.leaf_size = 1},
            make};
}

} // namespace alhazen
