#include "study/order_views.h"

#include <algorithm>

#include "study/random.h"

namespace palpa::study {
namespace {

struct View {
    int rotate_deg = 0;
    bool flip = false;
};

std::vector<View> all_views(const Protocol& protocol) {
    std::vector<View> views{{0, false}};
    if (protocol.turn_maps) views = {{0, false}, {90, false}, {180, false}, {270, false}};
    if (protocol.flip_maps) {
        const std::size_t n = views.size();
        for (std::size_t i = 0; i < n; ++i) views.push_back({views[i].rotate_deg, true});
    }
    return views;
}

// Returns 0, 4, 2, 6, 1, 5, 3, 7 for n = 8, a power of 2: any first few of these numbers are spread over all.
std::size_t spread_out(std::size_t i, std::size_t n) {
    std::size_t out = 0;
    for (std::size_t bit = 1; bit < n; bit *= 2) {
        out = 2 * out + i % 2;
        i /= 2;
    }
    return out;
}

// Returns the place of the view, among those with the greatest claim, that was not shown for longest.
std::size_t next_view(const std::vector<int>& claims, const std::vector<int>& last_shown, Random& random) {
    std::vector<std::size_t> best;
    for (std::size_t v = 0; v < claims.size(); ++v) {
        if (claims[v] <= 0) continue;
        if (!best.empty() && last_shown[v] > last_shown[best[0]]) continue;
        if (!best.empty() && last_shown[v] < last_shown[best[0]]) best.clear();
        best.push_back(v);
    }
    return best[random.below(static_cast<std::uint32_t>(best.size()))];
}

// Returns, by condition and view, in how many tests the condition is to be seen in this view.
std::vector<std::vector<int>> claims_of(const Protocol& protocol, const PlannedParticipant& who, std::size_t shift,
                                        std::size_t n) {
    std::vector<std::vector<int>> out(protocol.conditions.size());
    std::size_t slot = shift;
    for (const std::size_t condition : protocol.groups[who.group].conditions) {
        out[condition].assign(n, 0);
        const int tests = tests_of(protocol, condition);
        for (int i = 0; i < tests; ++i) ++out[condition][slot++ % n];
    }
    return out;
}

}  // namespace

void give_views(const Protocol& protocol, int place, std::uint64_t seed, PlannedParticipant& who) {
    std::vector<View> views = all_views(protocol);
    const std::size_t n = views.size();
    const std::size_t round = static_cast<std::size_t>(place) / n;
    const std::size_t shift = spread_out(static_cast<std::size_t>(place) % n, n);
    Random of_round(derived_seed(seed, who.group + 1, round));
    of_round.shuffle(views);
    Random random(derived_seed(seed, 0, static_cast<std::uint64_t>(who.number)));
    std::vector<std::vector<int>> left = claims_of(protocol, who, shift, n);
    const std::vector<std::vector<int>> tested = left;
    std::vector<int> last_shown(n, -1);
    for (std::size_t i = 0; i < who.trials.size(); ++i) {
        PlannedTrial& trial = who.trials[i];
        std::vector<int> claims = left[trial.condition];
        if (trial.practice) {
            const std::vector<int>& tests = tested[trial.condition];
            const bool all_tested = std::count(tests.begin(), tests.end(), 0) == 0;
            for (std::size_t v = 0; v < n; ++v) claims[v] = all_tested || tests[v] == 0 ? 1 : 0;
        }
        const std::size_t view = next_view(claims, last_shown, random);
        if (!trial.practice) --left[trial.condition][view];
        last_shown[view] = static_cast<int>(i);
        trial.rotate_deg = views[view].rotate_deg;
        trial.flip = views[view].flip;
    }
}

}  // namespace palpa::study
