#include <nlohmann/json.hpp>

#include "engine/cli/progress.h"

namespace coppice::cli {
namespace {

using Json = nlohmann::ordered_json;

Json json(const RunTotals& totals) {
  Json object = {{"to_run", totals.to_run},      {"up_to_date", totals.up_to_date},
                 {"running", totals.running},    {"finished", totals.finished},
                 {"failed", totals.failed},      {"skipped", totals.skipped},
                 {"elapsed_s", totals.elapsed_s}};
  object["remaining_s"] = totals.remaining_s ? Json(*totals.remaining_s) : Json();
  return object;
}

Json json(const NodeReport& report) {
  return {{"experiment", report.experiment},
          {"node", report.node->name},
          {"key", report.node->key},
          {"done", report.done},
          {"total", report.total},
          {"wall_s", report.wall_s},
          {"cpu_s", report.cpu_s}};
}

/// One JSON object per line and event; "progress" twice a second at most.
class JsonProgress : public RunListener {
 public:
  explicit JsonProgress(Console& console) : console_(console) {}

  void begin(const RunTotals& totals) override { say({{"event", "begin"}}, totals); }
  void started(const NodeReport& report, const RunTotals& totals) override { say("started", report, totals); }
  void finished(const NodeReport& report, const RunTotals& totals) override {
    say("finished", report, totals);
  }
  void failed(const NodeReport& report, const RunTotals& totals) override { say("failed", report, totals); }
  void skipped(const NodeReport& report, const RunTotals& totals) override { say("skipped", report, totals); }
  void interrupted(const NodeReport& report, const RunTotals& totals) override {
    say("interrupted", report, totals);
  }
  void tick(const std::vector<NodeReport>& running, const RunTotals& totals) override {
    if (totals.elapsed_s < next_s_) return;
    next_s_ = totals.elapsed_s + 0.5;
    Json object = {{"event", "progress"}, {"running", Json::array()}};
    for (const NodeReport& report : running) object["running"].push_back(json(report));
    say(std::move(object), totals);
  }
  void end(const RunTotals& totals) override { say({{"event", "end"}}, totals); }

 private:
  void say(const char* event, const NodeReport& report, const RunTotals& totals) {
    Json object = {{"event", event}};
    object.update(json(report));
    if (!report.message.empty()) object["message"] = report.message;
    say(std::move(object), totals);
  }
  void say(Json object, const RunTotals& totals) {
    object["totals"] = json(totals);
    console_.say(object.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n');
  }

  Console& console_;
  double next_s_ = 0;
};

}  // namespace

std::unique_ptr<RunListener> json_progress(Console& console) {
  return std::make_unique<JsonProgress>(console);
}

}  // namespace coppice::cli
