/// The paper's idea: a builder decides once, and early, who stands beside whom. Afterwards, with the whole
/// tree known, each node may ask: if I were taken out, and my parent, who is then not needed, with me, all
/// above us would shrink; beside which other node would I fit with the least growth? Think of books that were
/// put on shelves in the order in which they came: each is moved to the shelf where it makes the shelves'
/// labels shortest. What a move gains is the difference of the inner nodes' areas.
///
/// The search for the best place goes up from the node, ancestor by ancestor, and from each down into the
/// other side, never where even a node of no more than its own area would not gain. All nodes search at once.
/// Then moves that touch the same nodes compete: each locks all nodes it reads or changes by an atomic
/// maximum of its gain, and those that hold all their locks are carried out, at once. The others are measured
/// anew and try again. The paper locks a move's ends only and accepts that some boxes are not as expected;
/// here the paths to the common ancestor are locked as well, so that gains add up exactly and the cost cannot
/// rise. On a GPU all that takes kernels of one thread a node; here it is parallel loops over the same, and
/// what is lost is only the many threads that hide the searches' cache misses.
#include "accel/build/reinsertion.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>

#include "accel/build/linked_tree.h"
#include "accel/build/scale.h"
#include "base/threads.h"

namespace alhazen {

namespace {

constexpr std::size_t grain = 1024;
// Times that moves of one search compete.
constexpr int contests = 6;
// Gains below this share of the parent's area are noise.
constexpr float least_share = 1e-5f;
// While moves of one round pile up, paths may get longer than they may stay.
constexpr std::size_t longest_path = 2 * static_cast<std::size_t>(Tree::max_depth);

struct Node {
    Bounds3 box; // scaled (see scale.h)
    std::uint32_t parent = 0;
    std::array<std::uint32_t, 2> children{}; // of a leaf: 0, which is the root and nobody's child

    bool is_leaf() const { return children[0] == 0; }
};

float area_of_both(const Bounds3& a, const Bounds3& b) {
    Vec3 d = max(a.hi, b.hi) - min(a.lo, b.lo);
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

// Node is taken out and put beside target.
struct Move {
    std::uint32_t node = 0;
    std::uint32_t target = 0; // 0: none
    std::uint32_t common = 0; // the lowest node that is above both places and whose box stays
    float gain = 0;

    std::uint64_t key() const {
        return static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(gain)) << 32 | (0xffffffffu - node);
    }
};

// The tree while nodes move. The root stays where it is, and so do its children's places, though others may
// stand there.
class Nodes {
  public:
    explicit Nodes(const Tree& tree) : nodes_(tree.nodes.size()) {
        float scale = unit_scale(tree.nodes[0].bounds);
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            const Tree::Node& n = tree.nodes[i];
            nodes_[i].box = scaled(n.bounds, scale);
            if (n.is_leaf()) continue;
            nodes_[i].children = {i + 1, n.first_or_right};
            for (std::uint32_t child : nodes_[i].children) nodes_[child].parent = i;
        }
    }
    std::size_t size() const { return nodes_.size(); }
    const Node& operator[](std::uint32_t i) const { return nodes_[i]; }

    std::uint32_t sibling(std::uint32_t i) const {
        const Node& parent = nodes_[nodes_[i].parent];
        return parent.children[parent.children[0] == i];
    }
    // Neither the root nor its children can be taken out.
    bool is_movable(std::uint32_t i) const { return i != 0 && nodes_[i].parent != 0; }

    // Heights of all subtrees, in edges.
    std::vector<std::uint8_t> heights() const {
        std::vector<std::uint8_t> heights(nodes_.size(), 0);
        measure(heights, 0, 0);
        return heights;
    }

    // The sum of the inner nodes' areas.
    double cost() const {
        return parallel_sum(
            nodes_.size(), grain, 0.0,
            [&](double& sum, std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    if (!nodes_[i].is_leaf()) sum += static_cast<double>(nodes_[i].box.half_area());
            },
            [](double& sum, double part) { sum += part; });
    }

    // Calls visit(i) for the nodes that a move changes, or that must not change meanwhile.
    template <class Visit>
    void for_each_involved(const Move& move, const Visit& visit) const {
        std::uint32_t parent = nodes_[move.node].parent;
        for (std::uint32_t i : {move.node, parent, sibling(move.node), nodes_[parent].parent, move.target,
                                nodes_[move.target].parent})
            visit(i);
        for (std::uint32_t i = nodes_[parent].parent; i != move.common; i = nodes_[i].parent) visit(i);
        for (std::uint32_t i = move.target; i != move.common; i = nodes_[i].parent) visit(i);
    }

    // The parent is taken out together with the node, and put back between the target and its parent.
    void carry_out(const Move& move) {
        std::uint32_t parent = nodes_[move.node].parent, top = nodes_[parent].parent;
        std::uint32_t other = sibling(move.node);
        replace_child(top, parent, other);
        for (std::uint32_t i = top; i != move.common; i = nodes_[i].parent) {
            Node& n = nodes_[i];
            n.box = nodes_[n.children[0]].box;
            n.box.extend(nodes_[n.children[1]].box);
        }
        const Bounds3& box = nodes_[move.node].box;
        replace_child(nodes_[move.target].parent, move.target, parent);
        nodes_[parent].children = {move.target, move.node};
        nodes_[move.target].parent = parent;
        nodes_[parent].box = nodes_[move.target].box;
        for (std::uint32_t i = parent; i != move.common; i = nodes_[i].parent) nodes_[i].box.extend(box);
    }

  private:
    void replace_child(std::uint32_t parent, std::uint32_t child, std::uint32_t by) {
        Node& n = nodes_[parent];
        n.children[n.children[1] == child] = by;
        nodes_[by].parent = parent;
    }
    void measure(std::vector<std::uint8_t>& heights, std::uint32_t i, int depth) const {
        const Node& n = nodes_[i];
        if (n.is_leaf()) return;
        auto left = [&] { measure(heights, n.children[0], depth + 1); };
        auto right = [&] { measure(heights, n.children[1], depth + 1); };
        if (depth < 8) {
            parallel_invoke(left, right);
        } else {
            left();
            right();
        }
        int height = 1 + std::max(heights[n.children[0]], heights[n.children[1]]);
        heights[i] = static_cast<std::uint8_t>(std::min(height, 255));
    }

    std::vector<Node> nodes_;
};

// One node's search for its best place.
class Search {
  public:
    Search(const Nodes& nodes, std::uint32_t node, int visits)
        : nodes_(nodes), box_(nodes[node].box), area_(box_.half_area()), visits_(visits) {
        best_.node = node;
    }

    Move run() {
        std::uint32_t up = nodes_[best_.node].parent, aside = nodes_.sibling(best_.node);
        float gain = nodes_[up].box.half_area();
        best_.gain = least_share * gain;
        Bounds3 shrunk = nodes_[aside].box;
        // Beside its sibling it stands already; but not beside those below.
        if (!nodes_[aside].is_leaf()) go_down_from(aside, shrunk.half_area());
        for (;;) {
            aside = nodes_.sibling(up);
            go_down(aside, gain);
            up = nodes_[up].parent;
            if (up == 0 || visits_ <= 0) break;
            shrunk.extend(nodes_[aside].box);
            float before = nodes_[up].box.half_area();
            gain += before - shrunk.half_area();
            propose(up, gain - before);
        }
        return best_;
    }

  private:
    struct Entry {
        std::uint32_t node;
        float gain; // of the move so far, without the new parent's area
    };

    void propose(std::uint32_t target, float gain) {
        if (!(gain > best_.gain)) return;
        best_.gain = gain;
        best_.target = target;
    }
    bool is_hopeless(float gain) const { return !(gain - area_ > best_.gain); }

    void go_down(std::uint32_t from, float gain) {
        if (is_hopeless(gain)) return;
        --visits_;
        float both = area_of_both(nodes_[from].box, box_);
        propose(from, gain - both);
        if (!nodes_[from].is_leaf()) go_down_from(from, gain - (both - nodes_[from].box.half_area()));
    }
    // Into the subtree below an inner node; gain: with that node grown.
    void go_down_from(std::uint32_t from, float gain) {
        std::array<Entry, longest_path> stack;
        std::size_t size = 0;
        stack[size++] = {from, gain};
        while (size > 0 && visits_ > 0) {
            Entry entry = stack[--size];
            if (is_hopeless(entry.gain)) continue;
            --visits_;
            std::array<Entry, 2> next{};
            for (std::size_t side = 0; side < 2; ++side) {
                std::uint32_t child = nodes_[entry.node].children[side];
                const Node& n = nodes_[child];
                float both = area_of_both(n.box, box_);
                propose(child, entry.gain - both);
                next[side] = {n.is_leaf() ? 0 : child, entry.gain - (both - n.box.half_area())};
            }
            // The more hopeful child is met first.
            std::size_t first = next[1].gain > next[0].gain;
            for (std::size_t side : {1 - first, first})
                if (next[side].node != 0 && !is_hopeless(next[side].gain)) stack[size++] = next[side];
        }
    }

    const Nodes& nodes_;
    Bounds3 box_;
    float area_;
    int visits_;
    Move best_;
};

// Measures a move in the tree as it is now: sets gain and common. False if it cannot be made or is no gain.
class Measure {
  public:
    Measure(const Nodes& nodes, const std::vector<std::uint8_t>& heights)
        : nodes_(nodes), heights_(heights) {}

    bool operator()(Move& move) {
        std::uint32_t parent = nodes_[move.node].parent;
        if (!nodes_.is_movable(move.node) || move.target == 0 || move.target == parent ||
            move.target == nodes_.sibling(move.node))
            return false;
        if (!find_common(move, parent)) return false;
        double gain = gain_of(move, parent);
        move.gain = static_cast<float>(gain);
        return gain > static_cast<double>(least_share * nodes_[parent].box.half_area());
    }

  private:
    // The paths to the root, as they are once the parent is out.
    bool find_common(Move& move, std::uint32_t parent) {
        std::size_t from = 0, to = 0;
        for (std::uint32_t i = nodes_[parent].parent;; i = nodes_[i].parent) {
            if (from == longest_path) return false;
            from_[from++] = i;
            if (i == 0) break;
        }
        for (std::uint32_t i = move.target;; i = nodes_[i].parent) {
            if (i == parent) continue;
            if (i == move.node || to == longest_path) return false;
            to_[to++] = i;
            if (i == 0) break;
        }
        // The target has so many edges above it, and gets one more.
        int below = std::max(heights_[move.node], heights_[move.target]);
        if (static_cast<int>(to) + below > Tree::max_depth) return false;
        while (from > 0 && to > 1 && from_[from - 1] == to_[to - 1]) {
            move.common = from_[from - 1];
            --from;
            --to;
        }
        return true;
    }
    double gain_of(const Move& move, std::uint32_t parent) const {
        const Bounds3& box = nodes_[move.node].box;
        double gain = static_cast<double>(nodes_[parent].box.half_area());
        Bounds3 shrunk = nodes_[nodes_.sibling(move.node)].box, target = nodes_[move.target].box;
        std::uint32_t below = parent;
        for (std::uint32_t i = nodes_[parent].parent; i != move.common; i = nodes_[i].parent) {
            shrunk.extend(nodes_[nodes_.sibling(below)].box);
            gain += static_cast<double>(nodes_[i].box.half_area()) - static_cast<double>(shrunk.half_area());
            if (i == move.target) target = shrunk;
            below = i;
        }
        gain -= static_cast<double>(area_of_both(target, box));
        for (std::uint32_t i = nodes_[move.target].parent; i != move.common; i = nodes_[i].parent)
            if (i != parent)
                gain -= static_cast<double>(area_of_both(nodes_[i].box, box)) -
                        static_cast<double>(nodes_[i].box.half_area());
        return gain;
    }

    const Nodes& nodes_;
    const std::vector<std::uint8_t>& heights_;
    std::array<std::uint32_t, longest_path> from_, to_;
};

class Reinserter {
  public:
    Reinserter(const Tree& tree, const ReinsertionOptions& options)
        : options_(options), nodes_(tree), locks_(tree.nodes.size()) {}

    void run() {
        auto turns = static_cast<int>(std::max(options_.stride, 1u));
        double before = nodes_.cost();
        for (int round = 0; round < options_.rounds; ++round) {
            if (!run_round(static_cast<std::uint32_t>(round % turns))) break;
            if (round % turns != turns - 1) continue;
            double after = nodes_.cost();
            if (!(before - after > options_.least_gain * before)) break;
            before = after;
        }
    }
    const Nodes& nodes() const { return nodes_; }

  private:
    // False: paths would get too long, and all is as before.
    bool run_round(std::uint32_t turn) {
        Nodes before = nodes_;
        std::vector<std::uint8_t> heights = nodes_.heights();
        std::vector<Move> moves = search(turn);
        for (int contest = 0; contest < contests && !moves.empty(); ++contest) compete(moves, heights);
        take_turns(moves, heights);
        if (nodes_.heights()[0] <= Tree::max_depth) return true;
        nodes_ = std::move(before);
        return false;
    }

    std::vector<Move> search(std::uint32_t turn) const {
        std::uint32_t stride = std::max(options_.stride, 1u);
        std::vector<Move> moves(nodes_.size() / stride + 1);
        parallel_ranges(moves.size(), grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                auto i = static_cast<std::uint32_t>(k) * stride + turn;
                if (i < nodes_.size() && nodes_.is_movable(i))
                    moves[k] = Search(nodes_, i, options_.visits).run();
            }
        });
        std::erase_if(moves, [](const Move& m) { return m.target == 0; });
        return moves;
    }

    // Carries out the moves that win against all they meet; the others that still gain are left in moves.
    void compete(std::vector<Move>& moves, const std::vector<std::uint8_t>& heights) {
        for_each(moves, [&](Move& m) {
            if (!Measure(nodes_, heights)(m)) m.target = 0;
        });
        std::erase_if(moves, [](const Move& m) { return m.target == 0; });
        for_each(moves, [&](Move& m) {
            nodes_.for_each_involved(m, [&](std::uint32_t i) { raise(locks_[i], m.key()); });
        });
        std::vector<std::uint8_t> wins(moves.size());
        for_each(moves, [&](Move& m) {
            bool won = true;
            nodes_.for_each_involved(
                m, [&](std::uint32_t i) { won &= locks_[i].load(std::memory_order_relaxed) == m.key(); });
            wins[static_cast<std::size_t>(&m - moves.data())] = won;
        });
        for_each(moves, [&](Move& m) {
            nodes_.for_each_involved(m,
                                     [&](std::uint32_t i) { locks_[i].store(0, std::memory_order_relaxed); });
        });
        for_each(moves, [&](Move& m) {
            if (!wins[static_cast<std::size_t>(&m - moves.data())]) return;
            nodes_.carry_out(m);
            m.target = 0;
        });
        std::erase_if(moves, [](const Move& m) { return m.target == 0; });
    }

    // Those that never won, one after the other, the greatest gain first. These are long moves, which all
    // meet near the root.
    void take_turns(std::vector<Move>& moves, const std::vector<std::uint8_t>& heights) {
        std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) { return a.key() > b.key(); });
        Measure measure(nodes_, heights);
        for (Move& m : moves)
            if (measure(m)) nodes_.carry_out(m);
    }

    template <class Visit>
    static void for_each(std::vector<Move>& moves, const Visit& visit) {
        parallel_ranges(moves.size(), grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) visit(moves[k]);
        });
    }
    static void raise(std::atomic<std::uint64_t>& lock, std::uint64_t key) {
        std::uint64_t held = lock.load(std::memory_order_relaxed);
        while (held < key && !lock.compare_exchange_weak(held, key, std::memory_order_relaxed)) {
        }
    }

    ReinsertionOptions options_;
    Nodes nodes_;
    std::vector<std::atomic<std::uint64_t>> locks_; // the greatest key of the moves that involve a node
};

} // namespace

void optimize_by_reinsertion(Tree& tree, const ReinsertionOptions& options) {
    if (tree.nodes.size() < 5) return;
    Reinserter reinserter(tree, options);
    reinserter.run();
    LinkedTree result = linked(std::move(tree));
    for (std::uint32_t i = 0; i < result.nodes.size(); ++i) {
        const Node& n = reinserter.nodes()[i];
        if (!n.is_leaf()) result.nodes[i].make_inner(n.children[0], n.children[1]);
    }
    tree = finish(std::move(result), {.leaf_size = 1});
}

} // namespace alhazen
