#include "engine/graph/events.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

Event node_event(std::string what, std::string node) {
  Event event;
  event.what = std::move(what);
  event.node = std::move(node);
  return event;
}

std::vector<std::string> nodes_of(const std::vector<Event>& events) {
  std::vector<std::string> nodes;
  for (const Event& event : events) nodes.push_back(event.node);
  return nodes;
}

class EventsTest : public ::testing::Test {
 protected:
  TemporaryFolder temporary_;
  const fs::path file_ = temporary_.path() / "events.jsonl";
};

TEST_F(EventsTest, ReadsBackWhatWasWritten) {
  Event event = node_event("failed", "scores variant=HA r003");
  event.time = "2024-02-29T23:59:59.123Z";
  event.key = "0123";
  event.message = "line 1\nline \"2\"\t\xc3\xa9";
  event.wall_s = 0.1;
  event.cpu_s = 0.0;
  {
    Journal journal(file_);
    journal.write(event);
    journal.write(node_event("started", ""));
    EXPECT_EQ(journal.error(), "");
  }
  const std::vector<Event> events = read_events(file_);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].time, event.time);
  EXPECT_EQ(events[0].what, event.what);
  EXPECT_EQ(events[0].node, event.node);
  EXPECT_EQ(events[0].key, event.key);
  EXPECT_EQ(events[0].message, event.message);
  EXPECT_EQ(events[0].wall_s, 0.1);
  EXPECT_EQ(events[0].cpu_s, 0.0);
  EXPECT_EQ(events[1].time.size(), event.time.size()) << "an event without time gets the present";
  EXPECT_FALSE(events[1].wall_s);
}

TEST_F(EventsTest, EveryLineIsAnObject) {
  {
    Journal journal(file_);
    journal.write(node_event("started", "a"));
    journal.write(node_event("finished", "not \xff UTF-8"));
  }
  std::ifstream lines(file_);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const nlohmann::json json = nlohmann::json::parse(line);
    EXPECT_TRUE(json.contains("time") && json.contains("event") && json.contains("node")) << line;
    EXPECT_FALSE(json.contains("wall_s")) << line;
  }
  EXPECT_EQ(count, 2u);
}

TEST_F(EventsTest, ATornLineCostsItselfOnly) {
  { Journal(file_).write(node_event("started", "first")); }
  const std::string whole = TemporaryFolder::read(file_);
  for (std::size_t length = 1; length < whole.size(); ++length) {
    std::ofstream(file_, std::ios::binary) << whole << whole.substr(0, length);
    EXPECT_EQ(nodes_of(read_events(file_)), (std::vector<std::string>{"first"})) << length;
    { Journal(file_).write(node_event("started", "next")); }
    const std::vector<std::string> nodes = nodes_of(read_events(file_));
    EXPECT_EQ(nodes.back(), "next") << length;
    EXPECT_EQ(nodes.size(), length + 1 == whole.size() ? 3u : 2u) << "only a line end was missing";
  }
}

TEST_F(EventsTest, LeavesOutForeignLines) {
  std::ofstream(file_)
      << "no json\n[1, 2]\n{\"event\": 3}\n\n{\"time\": \"t\", \"event\": \"started\"}\nnull\n"
      << "{\"time\": \"t\", \"event\": \"finished\", \"wall_s\": \"long\"}\n";
  const std::vector<Event> events = read_events(file_);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].what, "started");
}

TEST_F(EventsTest, SeveralWritersDoNotMixTheirLines) {
  constexpr std::size_t kEach = 200;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      Journal journal(file_);
      for (std::size_t i = 0; i < kEach; ++i) {
        Event event = node_event("started", std::to_string(thread));
        event.message = std::string(i * 10, 'x');
        journal.write(event);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(read_events(file_).size(), 4 * kEach);
}

TEST_F(EventsTest, NoJournalHasNoEvents) {
  EXPECT_TRUE(read_events(file_).empty());
  EXPECT_TRUE(read_events(temporary_.path()).empty());
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(EventsTest, FailuresAreRememberedNotThrown) {
  Journal impossible(temporary_.path() / "missing" / "events.jsonl");
  impossible.write(node_event("started", "a"));
  EXPECT_NE(impossible.error().find("missing/events.jsonl: No such file"), std::string::npos)
      << impossible.error();
  Journal full("/dev/full");
  full.write(node_event("started", "a"));
  EXPECT_EQ(full.error(), "cannot write /dev/full: No space left on device");
}

}  // namespace
}  // namespace coppice
