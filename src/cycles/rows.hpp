// Rows of points that a translation makes, and the seeds that they make superfluous.
#pragma once

#include <cstddef>
#include <vector>

#include "scene.hpp"

namespace insym {

/// The exact translations T by t that carry many points, and the rows of three and more that they make. Of a
/// seed (A, B, C) with all its points in rows along t, as any isometry f that takes A to B and B to C would
///   - leave t as it is: both links advance along t by the same s. If |s| > |t|, (A + t, B, C - t) has a
///     shorter step, and f = f' T: every second pin, the glide of a mirror and a row;
///   - turn it over: what the first link advances, the second goes back. f = T^k f' with the f' whose middle
///     is nearest to the middles of the rows;
///   - or, unless a translation as long makes rows there, carry no row along t: f is a copy T^k f' T^-k, and
///     those nearest to the middles of the rows stand for the others.
/// So a search without the superfluous ones finds of each family { T^i f T^j } some members, all of whose
/// cycles it finds. Immutable after construction.
///
/// Cost: 100,000 votes, the points for each translation; some steps for each translation and question.
class Rows {
public:
    /// None: nothing is superfluous.
    Rows() = default;
    explicit Rows(const Scene& scene);

    bool empty() const { return translations_.empty(); }
    std::size_t translations() const { return translations_.size(); }

    /// Does (A, B, C) follow from another seed and a translation? So does (C, B, A), then.
    bool superfluous(int a, int b, int c) const;

    /// Is (A, B, C) far from the middle of a row that has both A and C? A longer chain from the copy of the
    /// seed there comes to the same cycle, or from that beside it, as the chain meets its row in steps of t
    /// or 2 t.
    bool repeats(int a, int b, int c) const;

private:
    /// Another translation that is as long.
    struct Mate {
        Point vector;
        int place = -1;  ///< among translations_, or none
    };
    struct Translation {
        Point vector;
        double square = 0;  ///< of |t|
        double slack = 0;   ///< by which equal heights may differ
        std::vector<Mate> mates;
    };
    /// A point as a translation sees it. Heights are along t, times |t|.
    struct Place {
        double height = 0;
        double middle = 0, low = 0, high = 0;  ///< of its row
        int row = -1;                          ///< its first point; none: not in a row
        bool ahead = false;                    ///< the row goes on in the direction of t
        bool behind = false;
    };
    struct Seen {
        const Translation& t;
        const Place &a, &b, &c;
    };
    Seen seen(std::size_t k, int a, int b, int c) const {
        return {translations_[k], place(a, k), place(b, k), place(c, k)};
    }
    const Place& place(int point, std::size_t k) const {
        return places_[static_cast<std::size_t>(point) * translations_.size() + k];
    }
    bool may_exchange(const Mate& mate, int a, int b, int c) const;
    bool advances_alike(const Translation& t, const Mate& mate, int a, int b, int c) const;
    static bool off_middle(const Seen& s);
    static bool is_copy(const Seen& s, double near);

    const PointSet* points_ = nullptr;
    std::vector<Translation> translations_;
    std::vector<Place> places_;  // of each point, for each translation
};

}  // namespace insym
