#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "engine/data/hash.h"
#include "engine/graph/events.h"
#include "engine/graph/placement.h"
#include "engine/graph/store.h"
#include "registry/error.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

std::string key_of(const std::string& name) {
  return content_hash("key " + name);
}

class GarbageTest : public ::testing::Test {
 protected:
  /// A stored result of two files, one of which all results have.
  void store(const std::string& name) {
    Store store(out_ / "store");
    const fs::path made = store.begin(key_of(name));
    std::ofstream(made / "own.csv") << name;
    std::ofstream(made / "shared.csv") << "shared";
    std::ofstream(made / "timing.csv") << "wall_s\n";
    ResultRecord record;
    record.key = key_of(name);
    store.commit(made, record);
  }

  /// A run folder that shows these results.
  void show(const std::string& experiment, const std::vector<std::string>& names) {
    fs::create_directories(out_ / experiment / ".coppice");
    Placements placements;
    for (const std::string& name : names) placements["nodes/" + name] = {key_of(name), "", {}};
    write_placements(out_ / experiment / kPlacementsFile, placements);
  }

  void write_events(const std::string& experiment, const std::vector<Event>& events) {
    fs::create_directories(out_ / experiment);
    Journal journal(out_ / experiment / kJournalFile);
    for (const Event& event : events) journal.write(event);
  }

  static Event event(std::string what, const std::string& name = {}) {
    Event made;
    made.what = std::move(what);
    if (!name.empty()) made.key = key_of(name);
    return made;
  }

  bool has(const std::string& name) const { return reader_.find(key_of(name)).has_value(); }

  std::string error() {
    try {
      collect_garbage(out_, false);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return {};
  }

  TemporaryFolder temporary_;
  const fs::path out_ = temporary_.path() / "out";
  const StoreReader reader_{out_ / "store"};
};

TEST_F(GarbageTest, RemovesWhatNoRunFolderRefersTo) {
  for (const char* name : {"a", "b", "c", "d"}) store(name);
  show("one", {"a"});
  show("two", {"a", "c"});
  const std::uint64_t expected_bytes =
      2 * (1 + 7) + fs::file_size(reader_.record(key_of("b"))) + fs::file_size(reader_.record(key_of("d")));
  for (const bool dry_run : {true, false}) {
    const Garbage garbage = collect_garbage(out_, dry_run);
    EXPECT_EQ(garbage.results, 2u);
    EXPECT_EQ(garbage.objects, 2u);  // the shared one stays
    EXPECT_EQ(garbage.bytes, expected_bytes);
    EXPECT_TRUE(has("a") && has("c"));
    EXPECT_EQ(has("b"), dry_run);
    EXPECT_EQ(has("d"), dry_run);
  }
  EXPECT_FALSE(fs::exists(reader_.timing(key_of("b"))));
  EXPECT_TRUE(fs::exists(reader_.timing(key_of("a"))));
  const Garbage again = collect_garbage(out_, false);
  EXPECT_EQ(again.results + again.objects + again.bytes, 0u);
}

TEST_F(GarbageTest, KeepsWhatKilledRunsFinished) {
  for (const char* name : {"old", "first", "second"}) store(name);
  write_events("one", {event("run started"), event("finished", "old"), event("run done"),  //
                       event("run started"), event("finished", "first"),                   // killed
                       event("run started"), event("finished", "second")});                // killed again
  collect_garbage(out_, false);
  EXPECT_FALSE(has("old"));
  EXPECT_TRUE(has("first"));
  EXPECT_TRUE(has("second"));
}

TEST_F(GarbageTest, KeepsCheckpointsOfTheLastRun) {
  { const Store store(out_ / "store"); }
  for (const char* name : {"abandoned", "interrupted"})
    std::ofstream(reader_.checkpoint(key_of(name))) << "checkpoint";
  write_events("one", {event("run started"), event("interrupted", "abandoned"), event("run interrupted"),
                       event("run started"), event("interrupted", "interrupted"), event("run interrupted")});
  EXPECT_EQ(collect_garbage(out_, false).bytes, 10u);
  EXPECT_FALSE(fs::exists(reader_.checkpoint(key_of("abandoned"))));
  EXPECT_TRUE(fs::exists(reader_.checkpoint(key_of("interrupted"))));
}

TEST_F(GarbageTest, RefusesWhileARunUsesTheStore) {
  store("a");
  {
    const Store running(out_ / "store");
    EXPECT_NE(error().find("a run uses " + (out_ / "store").string()), std::string::npos) << error();
  }
  EXPECT_TRUE(has("a"));
  EXPECT_EQ(error(), "");
  EXPECT_FALSE(has("a"));
}

TEST_F(GarbageTest, RefusesWhenAReferenceIsUnreadable) {
  store("a");
  show("one", {"a"});
  std::ofstream(out_ / "one" / kPlacementsFile, std::ios::app) << "damaged";
  EXPECT_NE(error().find((out_ / "one").string()), std::string::npos) << error();
  EXPECT_TRUE(has("a"));
}

TEST_F(GarbageTest, SaysWhereThereIsNoStore) {
  EXPECT_NE(error().find(out_.string() + " holds no results"), std::string::npos) << error();
  EXPECT_FALSE(fs::exists(out_));
}

}  // namespace
}  // namespace coppice
