#include "suggest.hpp"

#include <algorithm>
#include <numeric>

namespace insym::app {
namespace {

/// How many letters have to be changed, added or taken away (Levenshtein 1965).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string did_you_mean(std::string_view word, const std::vector<std::string>& names) {
    constexpr std::size_t kLongest = 100;  // more is no misspelling
    if (word.size() > kLongest) return "";
    const auto score = [&](const std::string& name) {
        const bool beginning = word.size() >= 4 && name.starts_with(word);
        return beginning ? std::size_t{1} : edit_distance(word, name);
    };
    const auto nearer = [&](const std::string& a, const std::string& b) { return score(a) < score(b); };
    const auto nearest = std::min_element(names.begin(), names.end(), nearer);
    const bool near =
        nearest != names.end() && score(*nearest) <= std::max<std::size_t>(1, nearest->size() / 3);
    return near ? "; did you mean " + *nearest + "?" : "";
}

}  // namespace insym::app
