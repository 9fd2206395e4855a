#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace coppice {

/// A small vector of doubles with inline storage; N is its capacity, its size may be less and is known at run
/// time (a state whose length depends on the configuration). Never allocates.
template <std::size_t N>
class Vec {
 public:
  static constexpr std::size_t kCapacity = N;

  constexpr Vec() : size_(N) {}  ///< N zeros
  constexpr Vec(std::initializer_list<double> values) : size_(values.size()) {
    assert(values.size() <= N);
    std::copy(values.begin(), values.end(), values_.begin());
  }
  constexpr explicit Vec(std::span<const double> values) : size_(values.size()) {
    assert(values.size() <= N);
    std::copy(values.begin(), values.end(), values_.begin());
  }

  constexpr std::size_t size() const { return size_; }
  /// New components are zero.
  constexpr void resize(std::size_t size) {
    assert(size <= N);
    for (std::size_t i = size_; i < size; ++i) values_[i] = 0;
    size_ = size;
  }
  constexpr double& operator[](std::size_t i) { return values_[i]; }
  constexpr double operator[](std::size_t i) const { return values_[i]; }
  constexpr double* begin() { return values_.data(); }
  constexpr double* end() { return values_.data() + size_; }
  constexpr const double* begin() const { return values_.data(); }
  constexpr const double* end() const { return values_.data() + size_; }
  friend constexpr bool operator==(const Vec& a, const Vec& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  std::array<double, N> values_{};
  std::size_t size_;
};

/// One component of a state or an action.
struct Axis {
  std::string name;  ///< snake_case; becomes the CSV column s_<name>, a_<name>
  std::string unit;  ///< SI, "" for plain numbers
  double low = 0;
  double high = 0;
  bool circular = false;  ///< an angle that wraps at its limits
  friend bool operator==(const Axis&, const Axis&) = default;
};

/// The middle of an axis; where one has an end at most, 0 or what is nearest to it.
double centre(const Axis& axis);

/// A box: the axes of a state space.
using Space = std::vector<Axis>;

/// The parameters of one kind of action: kick left, walk, ... Each action id has its own axes.
struct ActionBox {
  std::string name;
  Space axes;
  friend bool operator==(const ActionBox&, const ActionBox&) = default;
};

/// What an agent sees and does: the part of a problem that policies and files need.
struct Spaces {
  Space states;
  std::vector<ActionBox> actions;

  std::size_t state_size() const { return states.size(); }
  std::size_t widest_action() const;  ///< axes of the action with most of them
  /// Throws std::invalid_argument naming what is wrong: no axis, no action, too many axes, a name that is
  /// empty or stands twice, limits that are NaN or in the wrong order.
  void check() const;
  friend bool operator==(const Spaces&, const Spaces&) = default;
};

inline constexpr std::size_t kMaxStateSize = 32;
inline constexpr std::size_t kMaxActionSize = 12;

/// Which kind of action, and its parameters (as many as its box has axes).
struct Action {
  int id = 0;
  Vec<kMaxActionSize> values{std::initializer_list<double>{}};
  friend bool operator==(const Action&, const Action&) = default;
};

/// Moves each parameter into its box (circular axes are wrapped); a NaN becomes the box's centre. Throws
/// std::invalid_argument when there is no such action, or when it has another number of parameters.
void clamp_in_place(Action& action, const std::vector<ActionBox>& boxes);
Action clamp(Action action, const std::vector<ActionBox>& boxes);

}  // namespace coppice
