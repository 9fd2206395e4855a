#include "engine/vocabulary/dataset.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace coppice {
namespace {

void copy_rows(const Matrix& from, Matrix& to, std::size_t first) {
  for (std::size_t c = 0; c < from.columns(); ++c) {
    const std::span<const double> column = from.column(c);
    std::copy(column.begin(), column.end(), to.column(c).begin() + static_cast<std::ptrdiff_t>(first));
  }
}

template <class V>
void copy_rows(const std::vector<V>& from, std::vector<V>& to, std::size_t first) {
  std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace

Dataset::Dataset(Spaces axes, std::size_t rows)
    : spaces(std::move(axes)),
      episode(rows),
      step(rows),
      states(rows, spaces.state_size()),
      action_id(rows),
      actions(rows, spaces.widest_action()),
      reward(rows),
      next(rows, spaces.state_size()),
      terminal(rows) {}

Action Dataset::action(std::size_t row) const {
  Action action;
  action.id = action_id[row];
  action.values.resize(spaces.actions.at(static_cast<std::size_t>(action.id)).axes.size());
  for (std::size_t i = 0; i < action.values.size(); ++i) action.values[i] = actions(row, i);
  return action;
}

void Dataset::set_action(std::size_t row, const Action& action) {
  action_id[row] = action.id;
  for (std::size_t i = 0; i < actions.columns(); ++i) {
    actions(row, i) = i < action.values.size() ? action.values[i] : std::numeric_limits<double>::quiet_NaN();
  }
}

void Dataset::check() const {
  const std::size_t n = rows();
  const bool equal = episode.size() == n && step.size() == n && states.rows() == n && action_id.size() == n &&
                     actions.rows() == n && next.rows() == n && terminal.size() == n;
  const bool fits = states.columns() == spaces.state_size() && next.columns() == spaces.state_size() &&
                    actions.columns() == spaces.widest_action();
  if (!equal || !fits)
    throw std::logic_error("dataset: the columns differ in length, or do not fit the spaces");
}

Dataset join(const std::vector<Dataset>& parts) {
  if (parts.empty()) return {};
  std::size_t rows = 0;
  for (const Dataset& part : parts) {
    part.check();
    if (part.spaces != parts.front().spaces)
      throw std::invalid_argument("datasets of different spaces do not join");
    rows += part.rows();
  }
  Dataset all(parts.front().spaces, rows);
  std::size_t first = 0;
  std::int64_t episodes = 0;
  for (const Dataset& part : parts) {
    std::int64_t last = -1;
    for (std::size_t i = 0; i < part.rows(); ++i) {
      all.episode[first + i] = episodes + part.episode[i];
      last = std::max(last, part.episode[i]);
    }
    episodes += last + 1;
    copy_rows(part.step, all.step, first);
    copy_rows(part.states, all.states, first);
    copy_rows(part.action_id, all.action_id, first);
    copy_rows(part.actions, all.actions, first);
    copy_rows(part.reward, all.reward, first);
    copy_rows(part.next, all.next, first);
    copy_rows(part.terminal, all.terminal, first);
    first += part.rows();
  }
  return all;
}

}  // namespace coppice
