#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/vocabulary/archive.h"

namespace coppice {

/// The average of the last half to three quarters of a sequence of points, whose length nobody knows
/// beforehand: under noise better than the last point (averaging of iterates).
class MeanOfMeans {
 public:
  void add(std::span<const double> point) {
    if (count_ > 0 && (count_ & (count_ - 1)) == 0) {  // a power of two: the older block is dropped
      old_ = std::move(young_);
      old_count_ = young_count_;
      young_.clear();
      young_count_ = 0;
    }
    young_.resize(point.size(), 0);
    for (std::size_t i = 0; i < point.size(); ++i) young_[i] += point[i];
    ++young_count_;
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  std::vector<double> mean() const {
    std::vector<double> sum = young_;
    for (std::size_t i = 0; i < old_.size(); ++i) sum[i] += old_[i];
    for (double& s : sum) s /= static_cast<double>(young_count_ + old_count_);
    return sum;
  }
  void save(Archive& archive) const {
    archive.put("young", young_);
    archive.put("old", old_);
    archive.put("counts", std::vector<std::int64_t>{count_, young_count_, old_count_});
  }
  void load(const Archive& archive) {
    young_ = archive.get<std::vector<double>>("young");
    old_ = archive.get<std::vector<double>>("old");
    const auto& counts = archive.get<std::vector<std::int64_t>>("counts");
    count_ = counts.at(0);
    young_count_ = counts.at(1);
    old_count_ = counts.at(2);
  }

 private:
  std::vector<double> young_, old_;  ///< sums
  std::int64_t count_ = 0, young_count_ = 0, old_count_ = 0;
};

}  // namespace coppice
