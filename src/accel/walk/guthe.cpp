/// A walk that hides latency: Guthe 2014, "Latency Considerations of Depth-first GPU Ray Tracing".
///
/// The article's finding is that a depth-first walk waits, for nodes to come from memory and for one
/// instruction's result to reach the next, and does not run out of bandwidth or arithmetic. Its remedy is to
/// have more independent work at hand: nodes of four children in 128 bytes, so that one wait brings four
/// boxes, whose tests do not depend on each other; children visited depth first, nearest first, the others
/// put on the stack farthest first; and enough rays in flight a processor that another one can go on while
/// this one waits.
///
/// On a GPU the hardware switches between rays. A CPU core holds a single thread's instructions, so what it
/// is to overlap has to be in one instruction stream: a batch keeps several rays in flight in one thread,
/// each visits one node or leaf, asks for what it will need next to be fetched into the cache, and yields to
/// the next ray. Picture: a cook with several pans, who goes round and never watches one. The four children
/// go through one vector operation; for that the node's rows, which the article gives to children (x and y
/// planes of one child in a row), are turned into columns. Lost is the GPU's abundance: registers for
/// thousands of rays; here each switch moves a ray's state through the first cache. A single ray gets the
/// wide nodes only. The article fills a node by opening the child of largest surface, and before that one of
/// two leaves, so that no node is left half empty; collapse() finds the cheapest of all choices, these among
/// them.
#include <array>
#include <optional>

#include "accel/layout/multi_node.h"
#include "accel/list.h"
#include "accel/walk/walk_structure.h"

namespace alhazen {

namespace {

constexpr int width = 4;
using Layout = MultiLayout<width>;

/// A ray on its way.
template <Query query>
class Flight {
  public:
    Flight(const BoxRay& ray, const Nearest<query>& nearest) : test_(ray), nearest_(nearest) {}

    /// Visits one node or leaf; false when the query is answered.
    template <class Counter>
    bool step(const Layout& layout, Counter& counter) {
        if (current_.is_leaf()) {
            counter.leaf();
            if (nearest_.test(current_.index, static_cast<std::uint32_t>(current_.count))) return false;
            return pop();
        }
        counter.node();
        const MultiNode<width>& node = layout.nodes[current_.index];
        const auto hits = test_(node, nearest_.tmax());
        if (hits.count == 0) return pop();
        for (int i = hits.count - 1; i > 0; --i)
            stack_[height_++] = {node.child(hits.list[i].child), hits.list[i].t};
        counter.stack(height_);
        current_ = node.child(hits.list[0].child);
        return true;
    }
    /// Asks for what the next step reads.
    void prefetch(const Layout& layout, const LeafStore& store) const {
        const void* first = current_.is_leaf() ? static_cast<const void*>(&store.entries[current_.index])
                                               : &layout.nodes[current_.index];
        __builtin_prefetch(first);
        __builtin_prefetch(static_cast<const char*>(first) + 64);
    }
    bool found() const { return nearest_.found(); }

  private:
    bool pop() {
        do {
            if (height_ == 0) return false;
            --height_;
        } while (stack_[height_].t > nearest_.tmax());
        current_ = stack_[height_].child;
        return true;
    }

    struct Entry {
        MultiChild child;
        float t;
    };
    MultiTest<width> test_;
    Nearest<query> nearest_;
    MultiChild current_{0, 0};
    int height_ = 0;
    // Not set to anything, which would take longer than a short walk.
    Entry stack_[(width - 1) * CollapsedTree::max_depth];
};

struct GutheWalk {
    using Layout = alhazen::Layout;

    template <Query query, class Counter>
    static void walk(const Layout& layout, const BoxRay& ray, Nearest<query>& nearest, Counter& counter) {
        Flight<query> flight(ray, nearest);
        while (flight.step(layout, counter)) {
        }
    }
};

/// A batch of rays, several of them in flight. answer(i, found) is called once for each ray that can hit
/// something; hit_of(i, place) is where a ray's hit goes.
template <Query query, class HitOf, class Answer>
void interleave(const Layout& layout, const LeafStore& store, const Bounds3& bounds,
                std::span<const Ray> rays, PrimitiveTests& tests, const HitOf& hit_of, const Answer& answer) {
    constexpr std::size_t in_flight = 8;
    struct Place {
        std::optional<Flight<query>> flight;
        Intersection hit;
        std::size_t ray;
    };
    std::array<Place, in_flight> places;
    std::size_t next = 0, active = 0;
    // Starts the next ray, if there is one.
    auto start = [&](std::size_t p) {
        while (next < rays.size() && !is_traceable(rays[next])) ++next;
        if (next == rays.size()) return false;
        Place& place = places[p];
        place.hit = {};
        place.ray = next++;
        Nearest<query> nearest(store, rays[place.ray], hit_of(place.ray, place.hit), tests,
                               static_cast<std::uint32_t>(place.ray));
        place.flight.emplace(BoxRay(rays[place.ray], bounds), nearest);
        return true;
    };
    std::array<std::size_t, in_flight> round; // the places in use
    for (std::size_t p = 0; p < in_flight && start(p); ++p) round[active++] = p;
    NoCounts none;
    while (active > 0)
        for (std::size_t i = 0; i < active;) {
            const std::size_t p = round[i];
            bool goes_on = places[p].flight->step(layout, none);
            if (!goes_on) {
                answer(places[p].ray, places[p].flight->found());
                goes_on = start(p);
            }
            if (goes_on) {
                places[p].flight->prefetch(layout, store);
                ++i;
            } else {
                round[i] = round[--active];
            }
        }
}

class GutheStructure final : public WalkStructure<GutheWalk> {
  public:
    using WalkStructure::any;
    using WalkStructure::closest;
    using WalkStructure::WalkStructure;

    void closest(std::span<const Ray> rays, std::span<Intersection> hits,
                 PrimitiveTests& tests) const override {
        if (store().entries.empty()) return;
        auto hit_of = [&](std::size_t i, Intersection&) -> Intersection& { return hits[i]; };
        interleave<Query::closest>(layout(), store(), bounds(), rays, tests, hit_of,
                                   [](std::size_t, bool) {});
    }
    void any(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
             PrimitiveTests& tests) const override {
        std::fill_n(blocked.begin(), rays.size(), std::uint8_t{0});
        if (store().entries.empty()) return;
        auto hit_of = [](std::size_t, Intersection& hit) -> Intersection& { return hit; };
        interleave<Query::any>(layout(), store(), bounds(), rays, tests, hit_of,
                               [&](std::size_t i, bool found) { blocked[i] = found; });
    }
};

std::unique_ptr<Structure> make(const Primitives& primitives, const Tree& tree, const WalkOptions&) {
    return std::make_unique<GutheStructure>(primitives, tree, Layout(tree));
}

} // namespace

AccelWalk guthe_walk() {
    return {"guthe", "nodes of 4, several rays in flight in a thread (Guthe 2014)", {}, make};
}

} // namespace alhazen
