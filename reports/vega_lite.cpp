#include "reports/vega_lite.h"

#include <nlohmann/json.hpp>

namespace coppice {
namespace {

using Json = nlohmann::ordered_json;

Json value_of(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) return *integer;
  const double value = number(cell);  // NaN and the infinities become null
  return value;
}

Json values_of(const Table& table) {
  Json values = Json::array();
  for (const std::vector<Cell>& row : table.rows) {
    Json object = Json::object();
    for (std::size_t c = 0; c < row.size(); ++c) object[table.columns[c].name] = value_of(row[c]);
    values.push_back(std::move(object));
  }
  return values;
}

Json channel(const std::string& field, const char* type, const std::string& title = {}) {
  Json made = {{"field", field}, {"type", type}};
  if (!title.empty()) made["title"] = title;
  return made;
}

/// Beginning of the axis where the data is, not at 0.
Json quantitative(const std::string& field, const std::string& title) {
  Json made = channel(field, "quantitative", title);
  made["scale"] = {{"zero", false}};
  return made;
}

/// Colour, dashes, rows of small figures; of more than that only the lines are kept apart.
Json grouping(const std::vector<std::string>& by, std::size_t from, bool dashes) {
  Json encoding = Json::object();
  std::vector<const char*> channels = {"color"};
  if (dashes) channels.push_back("strokeDash");
  std::size_t next = 0;
  for (std::size_t i = from; i < by.size(); ++i) {
    if (next < channels.size()) {
      encoding[channels[next++]] = channel(by[i], "nominal");
    } else {
      encoding["detail"].push_back(channel(by[i], "nominal"));
    }
  }
  return encoding;
}

void draw_line(Json& figure, const Table& table, const FigureLayout& layout, const std::string& x,
               const std::string& mean, const char* shape) {
  figure["encoding"] = grouping(layout.by, 0, true);
  figure["encoding"]["x"] = quantitative(x, x == "threshold" ? layout.y : x);
  if (table.columns[table.column(x)].type == ColumnInfo::Type::text) {
    figure["encoding"]["x"] = channel(x, "nominal");
  }
  const std::string title = mean == "share" ? "share better" : layout.y;
  Json band = {{"mark", {{"type", "area"}, {"opacity", 0.2}, {"interpolate", shape}}}};
  band["encoding"]["y"] = quantitative("ci95_low", title);
  band["encoding"]["y2"] = {{"field", "ci95_high"}};
  Json line = {{"mark", {{"type", "line"}, {"interpolate", shape}}}};
  line["encoding"]["y"] = quantitative(mean, title);
  figure["layer"] = {std::move(band), std::move(line)};
}

void draw_intervals(Json& figure, const FigureLayout& layout) {
  figure["encoding"] = grouping(layout.by, 1, false);
  if (!layout.by.empty()) figure["encoding"]["y"] = channel(layout.by.front(), "nominal");
  if (layout.by.size() > 1) figure["encoding"]["yOffset"] = channel(layout.by[1], "nominal");
  Json rule = {{"mark", "rule"}};
  rule["encoding"]["x"] = quantitative("ci95_low", layout.y);
  rule["encoding"]["x2"] = {{"field", "ci95_high"}};
  Json point = {{"mark", {{"type", "point"}, {"filled", true}}}};
  point["encoding"]["x"] = quantitative("mean", layout.y);
  figure["layer"] = {std::move(rule), std::move(point)};
}

void draw_histogram(Json& figure, const FigureLayout& layout) {
  figure["mark"] = "bar";
  figure["encoding"] = grouping(layout.by, 1, false);
  if (!layout.by.empty()) figure["encoding"]["row"] = channel(layout.by.front(), "nominal");
  figure["encoding"]["x"] = channel("bin_low", "quantitative", layout.y);
  figure["encoding"]["x"]["bin"] = {{"binned", true}};
  figure["encoding"]["x2"] = {{"field", "bin_high"}};
  figure["encoding"]["y"] = channel("count", "quantitative");
}

}  // namespace

std::string vega_lite(const Table& table, const FigureLayout& layout) {
  Json figure = {{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"}};
  if (layout.x == "cpu_s" || layout.x == "wall_s") {
    figure["usermeta"] = {{"reproducible", false}, {"reason", "times differ from run to run"}};
  }
  switch (layout.kind) {
    case FigureKind::line:
      draw_line(figure, table, layout, layout.x, "mean", "linear");
      break;
    case FigureKind::profile:
      draw_line(figure, table, layout, "threshold", "share", "step-after");
      break;
    case FigureKind::interval:
      draw_intervals(figure, layout);
      break;
    case FigureKind::histogram:
      draw_histogram(figure, layout);
      break;
  }
  figure["data"] = {{"values", values_of(table)}};
  return figure.dump(1) + "\n";
}

}  // namespace coppice
