#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/policy_model.h"
#include "engine/vocabulary/random.h"
#include "engine/vocabulary/space.h"
#include "registry/component.h"

namespace coppice {

class Simulator;

/// Chooses an action in a state. Made from parameters (and, when learned, from arrays), prepared once, then
/// immutable and shared by any number of rollouts and threads.
class Policy {
 public:
  static constexpr const char* kInterface = "policy";
  virtual ~Policy() = default;

  /// Called once, before any action: tells the spaces, and the model for planners (null when only the spaces
  /// are known). Throws std::invalid_argument when the policy does not fit them.
  virtual void prepare(const Spaces& spaces, const Simulator* model) = 0;

  /// Numbers remembered within an episode; the caller holds them, one set for each rollout.
  virtual std::size_t memory_size() const { return 0; }
  /// Sets the memory as it is at the start of an episode.
  virtual void reset(std::span<double> memory) const;

  /// The action for a state. `action` is overwritten; it lies in its box. `draws` are those of this scenario
  /// and step. Does not allocate.
  virtual void act(std::span<const double> state, std::span<double> memory, const Draws& draws,
                   Action& action) const = 0;

  /// Arrays of a learned policy; configured policies have none. load throws std::runtime_error for arrays
  /// that do not make a valid policy; it is called before prepare.
  virtual void save(Archive&) const {}
  virtual void load(Archive&) {}

  /// What people want to know of a learned policy: names and numbers ("leaves", 812; "depth", 14).
  virtual std::vector<std::pair<std::string, double>> facts() const { return {}; }

  /// What act() computes, for exports; called after prepare. Throws std::invalid_argument saying why it is no
  /// model of numbers (a sentence without its subject, "draws at random").
  virtual PolicyModel exported() const;
};

/// A policy with the resolved element that, with its arrays, makes it again.
using MadePolicy = Sub<Policy>;

}  // namespace coppice
