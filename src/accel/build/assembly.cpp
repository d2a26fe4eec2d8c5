#include "accel/build/assembly.h"

#include <algorithm>
#include <iterator>

#include "base/big_array.h"
#include "base/threads.h"

namespace alhazen {

namespace {

// Where parts begin in the tree.
struct Start {
    std::uint32_t node = 0, place = 0;
};

void copy_run(const Run& run, Start start, Tree& tree) {
    Tree::Node* to = tree.nodes.data() + start.node;
    for (Tree::Node n : run.nodes) {
        n.first_or_right += n.is_leaf() ? start.place : start.node;
        *to++ = n;
    }
    std::copy(run.order.begin(), run.order.end(), tree.order.begin() + start.place);
}

template <class T>
void resize(std::vector<T>& v, std::size_t size) {
    v.reserve(size);
    prefer_huge_pages(v.data(), size * sizeof(T));
    v.resize(size);
}

} // namespace

Parts parts_of(Run run) {
    Parts parts(1);
    parts[0].run = std::move(run);
    return parts;
}

Parts join_parts(const Bounds3& bounds, Parts left, Parts right) {
    Parts joined;
    joined.reserve(1 + left.size() + right.size());
    joined.push_back({Run{}, bounds, 1 + left.size()});
    std::move(left.begin(), left.end(), std::back_inserter(joined));
    std::move(right.begin(), right.end(), std::back_inserter(joined));
    return joined;
}

Tree assemble(const Parts& parts) {
    std::vector<Start> starts;
    starts.reserve(parts.size());
    Start next;
    for (const Part& part : parts) {
        starts.push_back(next);
        next.node += std::max(std::uint32_t{1}, static_cast<std::uint32_t>(part.run.nodes.size()));
        next.place += static_cast<std::uint32_t>(part.run.order.size());
    }
    Tree tree;
    parallel_invoke([&] { resize(tree.nodes, next.node); }, [&] { resize(tree.order, next.place); });
    parallel_for(parts.size(), 1, [&](std::size_t i) {
        const Part& part = parts[i];
        if (part.run.nodes.empty())
            tree.nodes[starts[i].node] = {part.bounds, starts[i + part.right].node, 0};
        else
            copy_run(part.run, starts[i], tree);
    });
    return tree;
}

} // namespace alhazen
