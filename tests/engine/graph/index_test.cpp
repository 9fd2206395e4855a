#include "engine/graph/index.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <thread>

#include "engine/data/hash.h"
#include "engine/graph/events.h"
#include "engine/graph/sqlite.h"
#include "engine/graph/store.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

IndexedNode node(const std::string& key, const std::string& family, const std::string& component,
                 double wall_s) {
  return {"experiment", "node " + key, key,        component,
          family,       wall_s,        2 * wall_s, "2024-01-01T00:00:00.000Z"};
}

class IndexTest : public ::testing::Test {
 protected:
  IndexTest() { fs::create_directories(out_); }

  void store(const std::string& key, const std::string& family, const std::string& component, double wall_s) {
    Store store(out_ / "store");
    ResultRecord record;
    record.key = key;
    record.family = family;
    record.component = component;
    record.wall_s = wall_s;
    store.commit(store.begin(key), record);
  }

  std::optional<double> predict(const std::string& family, const std::string& component = "none") const {
    return read_durations(out_).predict(family, component);
  }

  /// First column of the first row.
  std::string ask(const std::string& sql) const { return Database(file_, false, 1000).value(sql); }

  TemporaryFolder temporary_;
  const fs::path out_ = temporary_.path() / "out";
  const fs::path file_ = out_ / "index.sqlite";
};

TEST_F(IndexTest, PredictsTheMeanOfTheFamilyElseOfTheComponent) {
  {
    Index index(out_);
    ASSERT_TRUE(index.usable());
    index.add(node("a", "small", "train fpf", 1));
    index.add(node("b", "small", "train fpf", 3));
    index.add(node("c", "large", "train fpf", 11));
    index.add(node("d", "other", "evaluate", 100));
  }
  EXPECT_DOUBLE_EQ(predict("small", "train fpf").value(), 2);
  EXPECT_DOUBLE_EQ(predict("large", "train fpf").value(), 11);
  EXPECT_DOUBLE_EQ(predict("new", "train fpf").value(), 5);
  EXPECT_FALSE(predict("new", "new"));
}

TEST_F(IndexTest, IsReadWhileItIsWritten) {
  Index index(out_);
  index.add(node("a", "family", "component", 1));
  EXPECT_EQ(predict("family"), 1);
  Index second(out_);  // of another run
  second.add(node("b", "family", "component", 2));
  index.add(node("c", "family", "component", 6));
  EXPECT_EQ(predict("family"), 3);
}

TEST_F(IndexTest, RecordsRuns) {
  Index index(out_);
  index.begin_run("e", "10:00");
  EXPECT_EQ(ask("SELECT outcome FROM runs"), "running");
  index.end_run("e", "10:00", "10:05", "failed");
  EXPECT_EQ(ask("SELECT outcome || finished FROM runs"), "failed10:05");
  EXPECT_EQ(ask("SELECT COUNT(*) FROM runs"), "1");
}

TEST_F(IndexTest, IsMadeAgainFromStoreAndJournals) {
  const std::string told = content_hash("told"), silent = content_hash("silent");
  store(told, "family", "component", 4);
  store(silent, "family", "component", 8);
  fs::create_directories(out_ / "e");
  {
    Journal journal(out_ / "e" / kJournalFile);
    Event event;
    event.time = "2024-01-01T10:00:00.000Z";
    event.what = kRunStarted;
    journal.write(event);
    event.what = kNodeFinished;
    event.node = "scores";
    event.key = told;
    event.wall_s = 3;
    event.cpu_s = 5;
    journal.write(event);
    event.key = content_hash("collected as garbage");
    journal.write(event);
    event = {};
    event.what = "run done";
    journal.write(event);
  }
  { const Index index(out_); }
  EXPECT_EQ(ask("SELECT COUNT(*) FROM nodes"), "2");
  EXPECT_EQ(ask("SELECT experiment || ' ' || node || ' ' || wall_s || ' ' || cpu_s || ' ' || finished FROM "
                "nodes WHERE key = '" +
                told + "'"),
            "e scores 3.0 5.0 2024-01-01T10:00:00.000Z");
  EXPECT_EQ(ask("SELECT family || wall_s FROM nodes WHERE key = '" + silent + "'"), "family8.0");
  EXPECT_EQ(ask("SELECT outcome FROM runs WHERE experiment = 'e'"), "done");
  EXPECT_DOUBLE_EQ(predict("family").value(), 5.5);
}

TEST_F(IndexTest, PredictsFromTheStoreWithoutAnIndexAndMakesNone) {
  EXPECT_FALSE(predict("family"));
  store(content_hash("a"), "family", "component", 4);
  EXPECT_EQ(predict("family"), 4);
  EXPECT_EQ(predict("new", "component"), 4);
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(IndexTest, ADamagedIndexIsMadeAgain) {
  store(content_hash("a"), "family", "component", 4);
  { const Index index(out_); }
  const std::string whole = TemporaryFolder::read(file_);
  std::string scribbled = whole;
  for (std::size_t i = 5000; i < scribbled.size(); ++i) scribbled[i] = static_cast<char>(i * 31);
  const std::vector<std::string> damages = {"", "no database at all, but long enough to look at",
                                            whole.substr(0, whole.size() / 2), scribbled,
                                            std::string(whole.size(), '\0')};
  for (std::size_t i = 0; i < damages.size(); ++i) {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << damages[i];
    EXPECT_EQ(predict("family"), 4) << i << ": from the store meanwhile";
    Index index(out_);
    EXPECT_TRUE(index.usable()) << i;
    index.add(node("b", "family", "component", 8));
    EXPECT_EQ(predict("family"), 6) << i;
  }
}

TEST_F(IndexTest, AnIndexOfAnotherFormatIsMadeAgain) {
  {
    Database other(file_, true, 1000);
    other.execute("CREATE TABLE nodes(different TEXT); PRAGMA user_version=99");
  }
  Index index(out_);
  index.add(node("a", "family", "component", 1));
  EXPECT_EQ(predict("family"), 1);
}

TEST_F(IndexTest, ALockedIndexIsIgnored) {
  { const Index index(out_); }
  store(content_hash("a"), "family", "component", 4);
  Database holder(file_, false, 1000);
  holder.execute("PRAGMA locking_mode=EXCLUSIVE; BEGIN EXCLUSIVE");
  EXPECT_EQ(predict("family"), 4) << "from the store meanwhile";
  Index index(out_);
  index.add(node("b", "family", "component", 8));  // does nothing
  EXPECT_TRUE(fs::exists(file_));
  holder.execute("COMMIT");
}

TEST_F(IndexTest, AnImpossibleIndexIsIgnored) {
  fs::create_directories(file_ / "in the way");
  Index index(out_);
  EXPECT_FALSE(index.usable());
  index.add(node("a", "family", "component", 1));
  index.begin_run("e", "now");
  index.end_run("e", "now", "later", "done");
  EXPECT_FALSE(predict("family"));
  EXPECT_TRUE(fs::exists(file_ / "in the way"));
}

TEST_F(IndexTest, SeveralThreadsAdd) {
  Index index(out_);
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (int i = 0; i < 50; ++i)
        index.add(node(std::to_string(thread) + "/" + std::to_string(i), "family", "component", 1));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(ask("SELECT COUNT(*) FROM nodes"), "200");
}

}  // namespace
}  // namespace coppice
