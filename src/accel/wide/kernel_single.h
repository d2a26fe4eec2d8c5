/// A ray alone, from node to node. Here branches pay: most rays hit no child or one.
#pragma once

#include "accel/wide/kernel_boxes.h"
#include "accel/wide/kernel_leaf.h"

namespace {

/// What box tests need of the ray stays in registers.
template <bool any, bool counted>
class SingleWalk {
  public:
    ALHAZEN_INLINE SingleWalk(const WideQuery& query, WideSlot& slot, WideStack& stack)
        : query_(query), base_(query.base), slot_(slot), stack_(stack), boxes_(slot) {
        put_sentinel(stack);
    }

    /// Through all that is below.
    ALHAZEN_INLINE void run(std::uint32_t reference) {
        for (;; reference = pop()) {
            reference = descend(reference);
            if (reference == alhazen::wide_done) return;
            if (counted) ++slot_.leaves;
            if (!visit_leaf<any>(query_, base_, slot_, reference)) continue;
            if constexpr (any) {
                query_.blocked[slot_.ray] = 1;
                return;
            }
            boxes_.set_tmax(slot_.tmax);
        }
    }

  private:
    /// Down to the next leaf, or to the end.
    ALHAZEN_INLINE std::uint32_t descend(std::uint32_t reference) {
        while (!(reference & alhazen::wide_leaf)) {
            const char* at = base_ + reference;
            const auto* node = reinterpret_cast<const WideNode*>(at);
            if (counted) ++slot_.nodes;
            const Interval t = test_boxes(boxes_, at);
            const std::uint32_t hits = Lanes::at_most(t.entry, t.exit);
            if (hits == 0) {
                reference = pop();
                continue;
            }
            const std::uint32_t more = hits & (hits - 1);
            const auto one = static_cast<std::uint32_t>(__builtin_ctz(hits));
            if (more == 0) {
                reference = node->child[one];
                continue;
            }
            if (!any && (more & (more - 1)) == 0)
                reference = push_farther(t.entry, node, one, static_cast<std::uint32_t>(__builtin_ctz(more)));
            else if constexpr (any) {
                height_ += Lanes::push(t.entry, t.exit, node->child, stack_.reference + height_) - 1;
                reference = node->child[31 - static_cast<std::uint32_t>(__builtin_clz(hits))];
            } else {
                height_ +=
                    Lanes::push_in_order(t.entry, t.exit, node->child, order_of(slot_, at), slot_.is_reversed,
                                         stack_.reference + height_, stack_.entry + height_) -
                    1;
                reference = stack_.reference[height_];
            }
            if (counted && height_ >= slot_.highest) slot_.highest = height_ + 1;
        }
        return reference;
    }

    /// Of two children; returns the other.
    ALHAZEN_INLINE std::uint32_t push_farther(F entry, const WideNode* node, std::uint32_t one,
                                              std::uint32_t two) {
        const float t1 = Lanes::lane(entry, one), t2 = Lanes::lane(entry, two);
        const std::uint32_t c1 = node->child[one], c2 = node->child[two];
        const bool swapped = t2 < t1;
        stack_.reference[height_] = swapped ? c1 : c2;
        stack_.entry[height_++] = swapped ? t1 : t2;
        return swapped ? c2 : c1;
    }

    /// The next that is not beyond the nearest hit.
    ALHAZEN_INLINE std::uint32_t pop() {
        --height_;
        if constexpr (!any)
            while (stack_.entry[height_] > slot_.tmax) --height_;
        return stack_.reference[height_];
    }

    const WideQuery& query_;
    const char* base_;
    WideSlot& slot_;
    WideStack& stack_;
    std::uint32_t height_ = 1;
    InRegisters boxes_;
};

} // namespace
