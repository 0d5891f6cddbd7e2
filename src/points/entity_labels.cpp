#include "insym/entity_labels.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace insym {
namespace {

/// The lengths and areas that tell entities of one geometry apart; below 0 where there is none.
constexpr std::size_t kInvariants = 4;
using Invariants = std::array<double, kInvariants>;

Invariants invariants_of(const Entity& entity) {
    return {entity.radius.value_or(-1), entity.minor_radius.value_or(-1), entity.length.value_or(-1),
            entity.area.value_or(-1)};
}

/// Parts sets of entities by one invariant after the other and numbers what is left together.
class Divider {
public:
    Divider(const std::vector<Entity>& entities, double tolerance)
        : tolerance_(tolerance), labels_(entities.size()) {
        std::transform(entities.begin(), entities.end(), std::back_inserter(invariants_), invariants_of);
    }

    void divide(std::span<int> members, std::size_t level = 0) {
        if (level == kInvariants) {
            for (const int i : members) labels_[static_cast<std::size_t>(i)] = next_;
            ++next_;
            return;
        }
        const auto value = [&](int i) { return invariants_[static_cast<std::size_t>(i)][level]; };
        std::sort(members.begin(), members.end(), [&](int a, int b) { return value(a) < value(b); });
        for (std::size_t start = 0; start < members.size();) {
            std::size_t end = start + 1;
            while (end < members.size() && alike(value(members[end - 1]), value(members[end]))) ++end;
            divide(members.subspan(start, end - start), level + 1);
            start = end;
        }
    }

    std::vector<int> take_labels() { return std::move(labels_); }

private:
    /// `b` is the larger one; a value that is not a number is like no other.
    bool alike(double a, double b) const { return b - a <= tolerance_ * std::abs(b); }

    double tolerance_;
    int next_ = 0;
    std::vector<Invariants> invariants_;
    std::vector<int> labels_;
};

}  // namespace

std::vector<int> label_entities(const std::vector<Entity>& entities, const LabelOptions& options) {
    if (!(options.tolerance >= 0 && options.tolerance < 1))
        throw Error(ErrorCode::invalid_option, "label tolerance: must be a share from 0 to below 1");
    if (options.by == LabelBy::none) return {};
    const bool by_entity = options.by == LabelBy::entity;
    std::map<std::tuple<EntityKind, std::string, EntityRole>, std::vector<int>> sorts;
    for (std::size_t i = 0; i < entities.size(); ++i) {
        const Entity& entity = entities[i];
        sorts[{entity.kind, by_entity ? entity.geometry : "", by_entity ? entity.role : EntityRole::none}]
            .push_back(static_cast<int>(i));
    }
    Divider divider(entities, options.tolerance);
    for (auto& [sort, members] : sorts) divider.divide(members, by_entity ? 0 : kInvariants);
    return divider.take_labels();
}

}  // namespace insym
