#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/data/csv.h"
#include "engine/data/file_system.h"
#include "engine/data/table_file.h"
#include "engine/vocabulary/dataset.h"
#include "registry/source.h"
#include "registry/suggest.h"

namespace coppice {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Names that begin so are those of axes.
const std::vector<std::string> kAxisPrefixes = {"s_", "a_", "n_"};

/// What the cells of a column must be.
enum class CellKind { number, optional_number, count, flag };

/// One expected column, where it stands in the file, and its values.
struct Wanted {
  ColumnInfo info;
  CellKind kind = CellKind::number;
  std::size_t position = 0;
  std::vector<double> values = {};
};

const Space& widest_axes(const std::vector<ActionBox>& actions) {
  const auto narrower = [](const ActionBox& a, const ActionBox& b) { return a.axes.size() < b.axes.size(); };
  return std::max_element(actions.begin(), actions.end(), narrower)->axes;
}

void add_axes(std::vector<Wanted>& columns, std::string_view prefix, const Space& axes, CellKind kind,
              std::string_view doc) {
  for (const Axis& axis : axes) {
    columns.push_back({{fmt::format("{}_{}", prefix, axis.name), ColumnInfo::Type::number, axis.unit,
                        fmt::format("{}: {}.", doc, axis.name)},
                       kind});
  }
}

/// The columns of a dataset, in the order in which they are written.
std::vector<Wanted> dataset_columns(const Spaces& spaces) {
  using Type = ColumnInfo::Type;
  std::vector<Wanted> columns = {
      {{"episode", Type::integer, "", "Episode, from 0."}, CellKind::count},
      {{"step", Type::integer, "", "Step within the episode, from 0."}, CellKind::count}};
  add_axes(columns, "s", spaces.states, CellKind::number, "State");
  columns.push_back({{"action_id", Type::integer, "", "Which action, from 0."}, CellKind::count});
  add_axes(columns, "a", widest_axes(spaces.actions), CellKind::optional_number, "Action");
  columns.push_back({{"reward", Type::number, "", "Reward of the step."}, CellKind::number});
  add_axes(columns, "n", spaces.states, CellKind::number, "Next state");
  columns.push_back({{"terminal", Type::boolean, "", "1 when the next state is terminal."}, CellKind::flag});
  return columns;
}

/// Finds the columns in the header. `prefixes` begin the names that only expected columns may have.
void locate(std::vector<Wanted>& columns, const CsvReader& reader, const std::vector<std::string>& prefixes) {
  Diagnostics errors;
  if (reader.header().size() == 1 && reader.header().front().find_first_of(";\t") != std::string::npos) {
    throw ConfigError({Diagnostic{
        reader.header_place(0), "the header is one field", "fields are separated by commas", {}}});
  }
  std::vector<std::string> expected;
  for (const Wanted& column : columns) expected.push_back(column.info.name);
  for (Wanted& column : columns) {
    if (const std::optional<std::size_t> position = reader.column(column.info.name)) {
      column.position = *position;
    } else {
      errors.error(reader.header_place(0), fmt::format("the column '{}' is missing", column.info.name),
                   suggestion(column.info.name, reader.header()));
    }
  }
  for (std::size_t c = 0; c < reader.header().size(); ++c) {
    const std::string& name = reader.header()[c];
    const auto begins = [&name](const std::string& prefix) { return name.starts_with(prefix); };
    if (std::find(expected.begin(), expected.end(), name) == expected.end() &&
        std::any_of(prefixes.begin(), prefixes.end(), begins)) {
      errors.error(reader.header_place(c), fmt::format("the problem has no axis '{}'", name),
                   suggestion(name, expected));
    }
  }
  errors.throw_if_any();
}

/// The value of a cell, or what it should have been.
double parse_cell(std::string_view text, CellKind kind, const char*& wrong) {
  if (kind == CellKind::optional_number && text.empty()) return kMissing;
  if (kind == CellKind::flag && (text == "true" || text == "false")) return text == "true" ? 1 : 0;
  const std::optional<double> value = parse_number(text);
  if (!value) {
    wrong = "a finite number";
  } else if (kind == CellKind::count && (*value < 0 || *value > 0x1p53 || *value != std::floor(*value))) {
    wrong = "a whole number from 0";
  } else if (kind == CellKind::flag && *value != 0 && *value != 1) {
    wrong = "0 or 1";
  }
  return value.value_or(kMissing);
}

/// Reads all rows into the columns' values. `check` sees each row that is right in itself. Stops after so
/// many mistakes that nobody would read on.
template <class Check>
void read_rows(std::vector<Wanted>& columns, CsvReader& reader, const Check& check) {
  Diagnostics errors;
  while (reader.next() && errors.size() < kMaxCsvErrors) {
    const std::size_t before = errors.size();
    for (Wanted& column : columns) {
      const char* wrong = nullptr;
      column.values.push_back(parse_cell(reader[column.position], column.kind, wrong));
      if (wrong == nullptr) continue;
      errors.error(reader.place(column.position),
                   fmt::format("'{}': '{}' is not {}", column.info.name, reader[column.position], wrong));
    }
    if (errors.size() == before) check(errors);
  }
  errors.throw_if_any();
}

/// The last value read of a column is one that the axis allows, up to rounding: the problem would have taken
/// another action than the one that stands there.
void check_inside(const Axis& axis, const Wanted& column, const CsvReader& reader, Diagnostics& errors) {
  const double value = column.values.back();
  const double slack = 1e-6 * (axis.high - axis.low);
  if (axis.circular || (value >= axis.low - slack && value <= axis.high + slack)) return;
  errors.error(reader.place(column.position),
               fmt::format("'{}' is {}, and this action's is in [{}, {}]{}{}", column.info.name, value,
                           axis.low, axis.high, axis.unit.empty() ? "" : " ", axis.unit));
}

/// Rows stand in the order of their episodes and steps, and none follows an episode's terminal step.
class OrderCheck {
 public:
  /// Looks at the last row read.
  void row(const Wanted& episode, const Wanted& step, const Wanted& terminal, const CsvReader& reader,
           Diagnostics& errors) {
    const double number = episode.values.back(), time = step.values.back();
    if (number < episode_) {
      errors.error(reader.place(episode.position),
                   fmt::format("episode {} stands below episode {}", number, episode_),
                   "rows stand in the order of their episodes, then steps");
    } else if (number == episode_ && terminal_) {
      errors.error(reader.place(step.position),
                   fmt::format("episode {} goes on after a terminal step", number));
    } else if (number == episode_ && time <= step_) {
      errors.error(reader.place(step.position),
                   fmt::format("step {} of episode {} stands below step {}", time, number, step_),
                   "rows stand in the order of their episodes, then steps");
    }
    episode_ = number;
    step_ = time;
    terminal_ = terminal.values.back() != 0;
  }

 private:
  double episode_ = -1;
  double step_ = -1;
  bool terminal_ = false;
};

/// The action of the last row read exists, and has the parameters that it must have. `id` is the column of
/// the action's id; its parameters follow.
void check_action(const std::vector<Wanted>& columns, std::size_t id, const Spaces& spaces,
                  const CsvReader& reader, Diagnostics& errors) {
  const double action = columns[id].values.back();
  if (action >= static_cast<double>(spaces.actions.size())) {
    errors.error(reader.place(columns[id].position), fmt::format("there is no action {}", action),
                 fmt::format("valid: 0 to {}", spaces.actions.size() - 1));
    return;
  }
  const ActionBox& box = spaces.actions[static_cast<std::size_t>(action)];
  for (std::size_t i = 0; i < spaces.widest_action(); ++i) {
    const Wanted& column = columns[id + 1 + i];
    const bool given = !std::isnan(column.values.back());
    if (given && i < box.axes.size()) check_inside(box.axes[i], column, reader, errors);
    if (given == (i < box.axes.size())) continue;
    errors.error(reader.place(column.position),
                 fmt::format("'{}' must {} for action {} ('{}', {} parameters)", column.info.name,
                             given ? "be empty" : "have a number", action, box.name, box.axes.size()));
  }
}

/// Takes `count` columns from `first` on.
Matrix take(const std::vector<Wanted>& columns, std::size_t first, std::size_t count) {
  Matrix matrix(columns.front().values.size(), count);
  for (std::size_t c = 0; c < count; ++c) {
    const std::vector<double>& values = columns[first + c].values;
    std::copy(values.begin(), values.end(), matrix.column(c).begin());
  }
  return matrix;
}

template <class V>
void take(const Wanted& column, std::vector<V>& into) {
  std::transform(column.values.begin(), column.values.end(), into.begin(),
                 [](double value) { return static_cast<V>(value); });
}

void append(std::string& bytes, const Matrix& matrix, std::size_t row) {
  for (std::size_t c = 0; c < matrix.columns(); ++c) {
    append_csv(bytes, matrix(row, c));
    bytes += ',';
  }
}

void append(std::string& bytes, std::int64_t number) {
  const fmt::format_int text(number);
  bytes.append(text.data(), text.size());
}

}  // namespace

std::vector<std::string> dataset_column_names(const Spaces& spaces) {
  std::vector<std::string> names;
  for (const Wanted& column : dataset_columns(spaces)) names.push_back(column.info.name);
  return names;
}

void write_dataset(const std::filesystem::path& file, const Dataset& dataset) {
  dataset.check();
  std::vector<ColumnInfo> schema;
  std::string bytes;
  for (const Wanted& column : dataset_columns(dataset.spaces)) {
    if (!schema.empty()) bytes += ',';
    append_csv(bytes, column.info.name);
    schema.push_back(column.info);
  }
  bytes += '\n';
  for (std::size_t i = 0; i < dataset.rows(); ++i) {
    append(bytes, dataset.episode[i]);
    bytes += ',';
    append(bytes, dataset.step[i]);
    bytes += ',';
    append(bytes, dataset.states, i);
    append(bytes, dataset.action_id[i]);
    bytes += ',';
    append(bytes, dataset.actions, i);
    append_csv(bytes, dataset.reward[i]);
    bytes += ',';
    append(bytes, dataset.next, i);
    bytes += dataset.terminal[i] ? "1\n" : "0\n";
  }
  write_file(file, bytes);
  write_schema(file, schema);
}

void check_dataset_header(std::shared_ptr<const SourceFile> source, const Spaces& spaces) {
  const CsvReader reader(std::move(source));
  std::vector<Wanted> columns = dataset_columns(spaces);
  locate(columns, reader, kAxisPrefixes);
}

Dataset read_dataset(const std::filesystem::path& file, const Spaces& spaces) {
  CsvReader reader(read_source(file.string(), kLargestTable));
  std::vector<Wanted> columns = dataset_columns(spaces);
  locate(columns, reader, kAxisPrefixes);
  const std::size_t states = spaces.state_size();
  const std::size_t id = 2 + states;
  const std::size_t reward = id + 1 + spaces.widest_action();
  OrderCheck order;
  read_rows(columns, reader, [&](Diagnostics& errors) {
    check_action(columns, id, spaces, reader, errors);
    order.row(columns[0], columns[1], columns.back(), reader, errors);
  });
  if (columns.front().values.empty()) {
    throw ConfigError({Diagnostic{reader.header_place(0), "there are no rows below the header", {}, {}}});
  }

  Dataset dataset(spaces, columns.front().values.size());
  take(columns[0], dataset.episode);
  take(columns[1], dataset.step);
  dataset.states = take(columns, 2, states);
  take(columns[id], dataset.action_id);
  dataset.actions = take(columns, id + 1, spaces.widest_action());
  take(columns[reward], dataset.reward);
  dataset.next = take(columns, reward + 1, states);
  take(columns.back(), dataset.terminal);
  return dataset;
}

Matrix read_states(std::shared_ptr<const SourceFile> source, const Space& states) {
  CsvReader reader(std::move(source));
  std::vector<Wanted> columns;
  add_axes(columns, "s", states, CellKind::number, "State");
  locate(columns, reader, {"s_"});
  read_rows(columns, reader, [](Diagnostics&) {});
  return take(columns, 0, states.size());
}

}  // namespace coppice
