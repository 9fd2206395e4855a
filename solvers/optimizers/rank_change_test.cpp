#include "solvers/optimizers/rank_change_test.h"

#include <algorithm>
#include <vector>

namespace coppice {

void RankChangeTest::learn(std::int64_t generation, std::span<const double> first,
                           std::span<const double> second) {
  double pairs = 0, changed = 0;
  bool same = true;
  for (std::size_t i = 0; i < first.size(); ++i) {
    same = same && first[i] == second[i];
    for (std::size_t j = 0; j < i; ++j) {
      ++pairs;
      if ((first[i] < first[j]) != (second[i] < second[j])) ++changed;
    }
  }
  differ_ = differ_ || !same;
  if (pairs > 0) changes_ += kSmoothing * (changed / pairs - changes_);
  interval_ = same ? std::min(kRarest, 2 * interval_) : 1;
  next_ = generation + interval_;
}

void RankChangeTest::save(Archive& archive) const {
  archive.put("changes", std::vector<double>{changes_});
  archive.put("test", std::vector<std::int64_t>{differ_ ? 1 : 0, interval_, next_});
}

void RankChangeTest::load(const Archive& archive) {
  changes_ = archive.get<std::vector<double>>("changes").at(0);
  const auto& numbers = archive.get<std::vector<std::int64_t>>("test");
  differ_ = numbers.at(0) != 0;
  interval_ = numbers.at(1);
  next_ = numbers.at(2);
}

}  // namespace coppice
