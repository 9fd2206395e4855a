#include "engine/graph/store.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <map>
#include <thread>

#include "engine/data/hash.h"
#include "engine/graph/record.h"
#include "registry/error.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;
using Contents = std::map<std::string, std::string>;

std::string key_of(int number) {
  return content_hash("key " + std::to_string(number));
}

ResultRecord record_for(const std::string& key) {
  ResultRecord record;
  record.key = key;
  record.kind = "train";
  record.component = "train fpf double_integrator";
  record.family = content_hash("family");
  record.key_text = "node = train/1\nsolver = fpf/1\nsolver.note = \"quoted\" \\n \xc3\xa9\n";
  record.wall_s = 0.1;
  record.cpu_s = 1.0 / 3.0;
  return record;
}

void write_all(const fs::path& folder, const Contents& files) {
  for (const auto& [name, content] : files) {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << content;
  }
}

ResultRecord commit(Store& store, const std::string& key, const Contents& files) {
  const fs::path folder = store.begin(key);
  write_all(folder, files);
  return store.commit(folder, record_for(key));
}

/// What the store has for a key; nothing when it has no result.
std::optional<Contents> contents(const StoreReader& store, const std::string& key) {
  const std::optional<ResultRecord> record = store.find(key);
  if (!record) return std::nullopt;
  Contents files;
  for (const StoredFile& file : record->files) files[file.name] = read_file(store.object(file.hash));
  return files;
}

/// Replaces a file's bytes in place, whatever its permissions.
void overwrite(const fs::path& file, const std::string& content) {
  fs::permissions(file, fs::perms::owner_all);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

std::size_t count_files(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) count += entry.is_regular_file();
  return count;
}

/// The message of what `act` throws; "" when it throws nothing.
template <class Error, class Act>
std::string message_of(const Act& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

class StoreTest : public ::testing::Test {
 protected:
  TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path() / "out" / "store";
  const std::string key_ = key_of(0);
  const Contents files_ = {
      {"a.csv", "x\n1\n"}, {"deep/b.policy", std::string("\0\xff binary", 9)}, {"empty", ""}};
};

TEST_F(StoreTest, GivesBackWhatWasCommitted) {
  const ResultRecord record = record_for(key_);
  {
    Store store(folder_);
    EXPECT_FALSE(store.find(key_));
    commit(store, key_, files_);
  }
  const StoreReader store(folder_);
  EXPECT_EQ(contents(store, key_), files_);
  const std::optional<ResultRecord> found = store.find(key_);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->key, record.key);
  EXPECT_EQ(found->kind, record.kind);
  EXPECT_EQ(found->component, record.component);
  EXPECT_EQ(found->family, record.family);
  EXPECT_EQ(found->key_text, record.key_text);
  EXPECT_EQ(found->wall_s, record.wall_s);
  EXPECT_EQ(found->cpu_s, record.cpu_s);
  ASSERT_EQ(found->files.size(), 3u);
  EXPECT_EQ(found->files[0].name, "a.csv");
  EXPECT_EQ(found->files[0].size, 4u);
  EXPECT_EQ(found->files[0].hash, content_hash("x\n1\n"));
  EXPECT_EQ(found->files[1].name, "deep/b.policy");
  EXPECT_EQ(store.keys(), std::vector<std::string>{key_});
}

TEST_F(StoreTest, ObjectsAreReadOnlyAndNamedByTheirContent) {
  Store store(folder_);
  for (const StoredFile& file : commit(store, key_, files_).files) {
    struct stat info {};
    ASSERT_EQ(::stat(store.object(file.hash).c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0444u);
    EXPECT_EQ(file_hash(store.object(file.hash)), file.hash);
  }
}

TEST_F(StoreTest, EqualContentIsKeptOnce) {
  Store store(folder_);
  commit(store, key_of(1), {{"a", "same"}, {"b", "same"}});
  commit(store, key_of(2), {{"c", "same"}});
  EXPECT_EQ(count_files(folder_ / "objects"), 1u);
  EXPECT_EQ(contents(store, key_of(1)), (Contents{{"a", "same"}, {"b", "same"}}));
  EXPECT_EQ(contents(store, key_of(2)), (Contents{{"c", "same"}}));
}

TEST_F(StoreTest, TimingLiesBesideTheResult) {
  Store store(folder_);
  const ResultRecord record = commit(store, key_, {{"a", "1"}, {"timing.csv", "wall_s\n2\n"}});
  ASSERT_EQ(record.files.size(), 1u);
  EXPECT_EQ(record.files[0].name, "a");
  EXPECT_EQ(read_file(store.timing(key_)), "wall_s\n2\n");
}

TEST_F(StoreTest, CommitLeavesNothingElseAndEndsTheCheckpoint) {
  Store store(folder_);
  store.save_checkpoint(key_, "begun");
  store.save_checkpoint(key_, "half way");
  EXPECT_EQ(read_file(store.checkpoint(key_)), "half way");
  EXPECT_EQ(count_files(folder_ / "tmp"), 1u);  // the lock
  const fs::path made = store.begin(key_);
  EXPECT_TRUE(fs::is_empty(made));
  write_all(made, files_);
  store.commit(made, record_for(key_));
  EXPECT_FALSE(fs::exists(made));
  EXPECT_FALSE(fs::exists(store.checkpoint(key_)));
  const fs::path unwanted = store.begin(key_);
  write_all(unwanted, files_);
  store.abandon(unwanted);
  EXPECT_FALSE(fs::exists(unwanted));
}

TEST_F(StoreTest, OpeningItRemovesCheckpointsOfResultsAcknowledgedSince) {
  const std::string outlived = key_of(1), forced = key_of(2), unfinished = key_of(3), damaged = key_of(4);
  {
    Store store(folder_);
    for (const std::string& key : {outlived, forced}) commit(store, key, files_);
    commit(store, damaged, {{"lost", "with the power"}});
    coppice::remove_all(store.object(store.find(damaged)->files[0].hash));
    for (const std::string& key : {outlived, forced, unfinished, damaged})
      store.save_checkpoint(key, "half way");
    // As after a kill when the one was acknowledged, and while the other one was computed again.
    for (const std::string& key : {outlived, damaged}) {
      const auto acknowledged = fs::last_write_time(store.record(key));
      fs::last_write_time(store.checkpoint(key), acknowledged - std::chrono::milliseconds(1));
    }
    const auto acknowledged = fs::last_write_time(store.record(forced));
    fs::last_write_time(store.checkpoint(forced), acknowledged + std::chrono::seconds(1));
  }
  const Store store(folder_);
  EXPECT_FALSE(fs::exists(store.checkpoint(outlived)));
  EXPECT_TRUE(fs::exists(store.checkpoint(forced)));
  EXPECT_TRUE(fs::exists(store.checkpoint(unfinished)));
  EXPECT_TRUE(fs::exists(store.checkpoint(damaged)));
  EXPECT_EQ(contents(store, outlived), files_);
}

TEST_F(StoreTest, AnAbsentStoreHasNoResultsAndIsNotMade) {
  const StoreReader store(folder_);
  EXPECT_FALSE(store.find(key_));
  EXPECT_TRUE(store.keys().empty());
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(StoreTest, TakesAResultBack) {
  Store store(folder_);
  commit(store, key_, files_);
  store.remove(key_);
  EXPECT_FALSE(store.find(key_));
  store.remove(key_);  // there is nothing any more
  commit(store, key_, files_);
  EXPECT_EQ(contents(store, key_), files_);
}

TEST_F(StoreTest, ARecordCutAnywhereIsNoResult) {
  Store store(folder_);
  commit(store, key_, files_);
  const std::string text = read_file(store.record(key_));
  for (std::size_t length = 0; length + 1 < text.size(); ++length) {  // the last byte is a line end
    EXPECT_FALSE(parse_record(std::string_view(text).substr(0, length))) << length;
  }
  overwrite(store.record(key_), text.substr(0, text.size() / 2));
  EXPECT_FALSE(store.find(key_));
  commit(store, key_, files_);
  EXPECT_EQ(contents(store, key_), files_);
}

TEST_F(StoreTest, ARecordOfAnotherKeyOrFormatIsNoResult) {
  Store store(folder_);
  commit(store, key_, files_);
  const std::string text = read_file(store.record(key_));
  const std::string other = key_.substr(0, 2) + std::string(30, '0');
  write_file(store.record(other), text);
  EXPECT_FALSE(store.find(other));
  std::string newer = text;
  newer.replace(newer.find("\"format\": 1"), 11, "\"format\": 2");
  EXPECT_TRUE(parse_record(text));
  EXPECT_FALSE(parse_record(newer));
}

TEST_F(StoreTest, ADamagedObjectIsNoResultUntilItIsMadeAgain) {
  Store store(folder_);
  const fs::path object = store.object(commit(store, key_, files_).files[0].hash);
  const std::vector<std::function<void()>> damages = {
      [&] { fs::remove(object); }, [&] { overwrite(object, "x\n1"); },
      [&] { overwrite(object, "x\n2\n"); },  // of the same size
      [&] { overwrite(object, ""); }};
  for (std::size_t i = 0; i < damages.size(); ++i) {
    damages[i]();
    EXPECT_FALSE(store.find(key_)) << i;
    EXPECT_TRUE(store.read(key_)) << i;
    commit(store, key_, files_);
    EXPECT_EQ(contents(store, key_), files_) << i;
  }
}

TEST_F(StoreTest, ACopiedStoreHasTheSameResults) {
  {
    Store store(folder_);
    commit(store, key_, files_);
  }
  const fs::path copy = temporary_.path() / "copy";
  fs::copy(folder_, copy, fs::copy_options::recursive);  // times of files are not kept
  EXPECT_EQ(contents(StoreReader(copy), key_), files_);
}

TEST_F(StoreTest, SeveralThreadsCommitAtOnce) {
  Store store(folder_);
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 8; ++thread) {
    threads.emplace_back([&, thread] {
      for (int i = 0; i < 5; ++i) {
        commit(store, key_of(i), files_);  // all the same result
        commit(store, key_of(100 + thread), {{"mine", std::to_string(thread)}, {"common", "common"}});
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(contents(store, key_of(i)), files_);
  for (int thread = 0; thread < 8; ++thread) {
    EXPECT_EQ(contents(store, key_of(100 + thread)),
              (Contents{{"mine", std::to_string(thread)}, {"common", "common"}}));
  }
  EXPECT_EQ(count_files(folder_ / "objects"), 3u + 8u + 1u);
}

TEST_F(StoreTest, SeveralStoresShareAFolder) {
  Store one(folder_), other(folder_);
  const fs::path mine = one.begin(key_), theirs = other.begin(key_);
  EXPECT_NE(mine, theirs);
  write_all(mine, files_);
  write_all(theirs, files_);
  { const Store third(folder_); }  // takes nothing from living ones
  one.commit(mine, record_for(key_));
  EXPECT_EQ(contents(other, key_), files_);
  other.commit(theirs, record_for(key_));
  EXPECT_EQ(contents(one, key_), files_);
}

// Failures.

TEST_F(StoreTest, AnImpossibleFolderIsAMistakeOfTheUser) {
  write_file(temporary_.path() / "file", "no folder");
  const std::string below_file = (temporary_.path() / "file" / "store").string();
  const std::string message = message_of<ConfigError>([&] { Store store(below_file); });
  EXPECT_NE(message.find("cannot make the folder " + below_file), std::string::npos) << message;
  EXPECT_NE(message.find("Not a directory"), std::string::npos) << message;
  EXPECT_NE(message_of<ConfigError>([] { Store store("/proc/store"); }), "");
}

TEST_F(StoreTest, AFailedCommitNamesTheFileAndAcknowledgesNothing) {
  Store store(folder_);
  fs::remove(folder_ / "objects");
  write_file(folder_ / "objects", "in the way");
  const fs::path made = store.begin(key_);
  write_all(made, files_);
  const std::string message = message_of<std::runtime_error>([&] { store.commit(made, record_for(key_)); });
  EXPECT_NE(message.find((folder_ / "objects").string()), std::string::npos) << message;
  EXPECT_FALSE(store.find(key_));
  fs::remove(folder_ / "objects");
  store.commit(made, record_for(key_));
  EXPECT_EQ(contents(store, key_), files_);
}

TEST_F(StoreTest, RefusesWhatIsNotAFile) {
  Store store(folder_);
  const fs::path made = store.begin(key_);
  fs::create_symlink("/etc/passwd", made / "link");
  const std::string message = message_of<std::runtime_error>([&] { store.commit(made, record_for(key_)); });
  EXPECT_NE(message.find((made / "link").string() + ": it is not a regular file"), std::string::npos)
      << message;
  EXPECT_FALSE(store.find(key_));
}

}  // namespace
}  // namespace coppice
