#include "reports/vega_lite.h"

#include <algorithm>
#include <array>
#include <cmath>
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

/// Tells apart by the given channels, then in rows and columns of small figures; of more than that only the
/// marks are kept apart.
void group(Json& figure, const std::vector<std::string>& by, const std::vector<const char*>& channels) {
  constexpr std::array<const char*, 2> kFacets = {"row", "column"};
  figure["encoding"] = Json::object();
  for (std::size_t i = 0; i < by.size(); ++i) {
    const Json named = channel(by[i], "nominal");
    if (i < channels.size()) {
      figure["encoding"][channels[i]] = named;
    } else if (i < channels.size() + kFacets.size()) {
      figure["facet"][kFacets[i - channels.size()]] = named;
    } else {
      figure["encoding"]["detail"].push_back(named);
    }
  }
}

/// What is drawn once in each small figure goes into its specification.
void move_into_facets(Json& figure) {
  if (!figure.contains("facet")) return;
  for (const char* part : {"encoding", "mark", "layer"}) {
    if (!figure.contains(part)) continue;
    figure["spec"][part] = std::move(figure[part]);
    figure.erase(part);
  }
}

/// The layer of intervals, if there are any, below that of means.
Json layers(const Table& table, Json intervals, Json means) {
  const std::size_t low = table.column("ci95_low");
  const bool any = std::any_of(table.rows.begin(), table.rows.end(),
                               [&](const std::vector<Cell>& row) { return !std::isnan(number(row[low])); });
  return any ? Json::array({std::move(intervals), std::move(means)}) : Json::array({std::move(means)});
}

/// A layer of single points; they leave the other layers.
void add_observations(Json& layers, const std::string& mean) {
  const auto only = [](const char* what) {
    return Json::array({{{"filter", {{"field", "drawn"}, {"equal", what}}}}});
  };
  for (Json& layer : layers) layer["transform"] = only("line");
  Json points = {{"transform", only("point")}, {"mark", "point"}};
  points["encoding"]["y"] = quantitative(mean, "");
  points["encoding"]["y"].erase("title");
  layers.push_back(std::move(points));
}

void draw_line(Json& figure, const Table& table, const FigureLayout& layout, const std::string& x,
               const std::string& mean, const char* shape) {
  group(figure, layout.by, {"color", "strokeDash"});
  Json dash;  // an area has none, but must be one for each line
  if (layout.by.size() > 1) {
    dash = figure["encoding"]["strokeDash"];
    figure["encoding"].erase("strokeDash");
  }
  figure["encoding"]["x"] = quantitative(x, x == "threshold" ? layout.y : x);
  if (table.columns[table.column(x)].type == ColumnInfo::Type::text) {
    figure["encoding"]["x"] = channel(x, "nominal");
  }
  const std::string title = mean == "share" ? "share better" : layout.y;
  Json band = {{"mark", {{"type", "area"}, {"opacity", 0.2}, {"interpolate", shape}}}};
  band["encoding"]["y"] = quantitative("ci95_low", title);
  band["encoding"]["y2"] = {{"field", "ci95_high"}};
  if (!dash.is_null()) {
    band["encoding"]["detail"] = figure["encoding"].value("detail", Json::array());
    band["encoding"]["detail"].push_back(dash);
  }
  Json line = {{"mark", {{"type", "line"}, {"interpolate", shape}}}};
  if (layout.points) line["mark"]["point"] = true;
  line["encoding"]["y"] = quantitative(mean, title);
  if (!dash.is_null()) line["encoding"]["strokeDash"] = dash;
  figure["layer"] = layers(table, std::move(band), std::move(line));
  if (layout.observations) add_observations(figure["layer"], mean);
}

void draw_intervals(Json& figure, const Table& table, const FigureLayout& layout) {
  group(figure, layout.by, {"y", "color"});
  if (layout.by.size() > 1) figure["encoding"]["yOffset"] = channel(layout.by[1], "nominal");
  Json rule = {{"mark", "rule"}};
  rule["encoding"]["x"] = quantitative("ci95_low", layout.y);
  rule["encoding"]["x2"] = {{"field", "ci95_high"}};
  Json point = {{"mark", {{"type", "point"}, {"filled", true}}}};
  point["encoding"]["x"] = quantitative("mean", layout.y);
  figure["layer"] = layers(table, std::move(rule), std::move(point));
}

void draw_histogram(Json& figure, const FigureLayout& layout) {
  figure["mark"] = "bar";
  group(figure, layout.by, {});
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
      draw_intervals(figure, table, layout);
      break;
    case FigureKind::histogram:
      draw_histogram(figure, layout);
      break;
  }
  move_into_facets(figure);
  figure["data"] = {{"values", values_of(table)}};
  return figure.dump(1) + "\n";
}

}  // namespace coppice
