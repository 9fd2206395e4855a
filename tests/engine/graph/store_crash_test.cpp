// What is left of a store when processes are killed or the disk is full.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <map>

#include "engine/data/hash.h"
#include "engine/graph/store.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

/// The files of result `number`; some are those of other results too.
std::vector<std::pair<std::string, std::string>> files_of(int number) {
  return {{"own.csv", "result " + std::to_string(number)},
          {"large.csv", std::string(20'000, static_cast<char>('a' + number % 26))},
          {"shared.csv", "in all results"},
          {"timing.csv", "wall_s\n1\n"}};
}

std::string crash_key(int number) {
  return content_hash("key " + std::to_string(number));
}

void commit(Store& store, int number) {
  const fs::path folder = store.begin(crash_key(number));
  store.save_checkpoint(crash_key(number), "half way");
  for (const auto& [name, content] : files_of(number)) std::ofstream(folder / name) << content;
  ResultRecord record;
  record.key = crash_key(number);
  store.commit(folder, record);
}

/// True when the result is there; what is there must be whole.
bool check(const StoreReader& store, int number) {
  const std::optional<ResultRecord> record = store.find(crash_key(number));
  if (!record) return false;
  std::map<std::string, std::string> stored;
  for (const StoredFile& file : record->files) stored[file.name] = read_file(store.object(file.hash));
  EXPECT_EQ(stored.size(), 3u);
  for (const auto& [name, content] : files_of(number)) {
    if (name == "timing.csv") {
      EXPECT_EQ(read_file(store.timing(record->key)), content);
    } else {
      EXPECT_EQ(stored[name], content) << "result " << number;
    }
  }
  return true;
}

/// Runs `act` in a process of its own.
pid_t start(const std::function<void()>& act) {
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      act();
    } catch (...) {
      ::_exit(99);
    }
    ::_exit(0);
  }
  return child;
}

int status_of(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

std::size_t folders_in(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) count += entry.is_directory();
  return count;
}

std::size_t files_in(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) count += entry.is_regular_file();
  return count;
}

TEST(StoreCrash, NothingAcknowledgedIsLostAndNothingIsHalfThere) {
  constexpr int kKills = 40;
  constexpr int kResults = 1000;
  const TemporaryFolder temporary;
  const fs::path folder = temporary.path() / "store";
  int acknowledged = 0, killed_while_working = 0, killed_within_commits = 0;
  for (int kill = 0; kill < kKills; ++kill) {
    int pipe[2];
    ASSERT_EQ(::pipe(pipe), 0);
    // Each process goes on where the one before was killed, at some point of its third commit or so.
    const pid_t child = start([&] {
      Store store(folder);
      for (int number = acknowledged; number < kResults; ++number) {
        commit(store, number);
        if (::write(pipe[1], "+", 1) != 1) ::_exit(98);
      }
    });
    ::close(pipe[1]);
    char byte = 0;
    for (int i = 0; i < 2 && ::read(pipe[0], &byte, 1) == 1; ++i) ++acknowledged;
    ::usleep(static_cast<useconds_t>(kill * 97 % 4000));
    ::kill(child, SIGKILL);
    if (WIFSIGNALED(status_of(child))) ++killed_while_working;
    while (::read(pipe[0], &byte, 1) == 1) ++acknowledged;
    ::close(pipe[0]);
    if (files_in(folder / "tmp") > 1) ++killed_within_commits;  // one is the lock
    const StoreReader store(folder);
    for (int number = 0; number < acknowledged; ++number) {
      ASSERT_TRUE(check(store, number)) << "lost result " << number << " after " << kill << " kills";
    }
    check(store, acknowledged);  // there or not
    ASSERT_FALSE(check(store, acknowledged + 1));
  }
  EXPECT_EQ(killed_while_working, kKills);
  EXPECT_GT(killed_within_commits, 0);
  EXPECT_GE(acknowledged, 2 * kKills);
  const Store store(folder);
  EXPECT_EQ(folders_in(folder / "tmp"), 1u) << "leftovers of killed processes";
  for (const auto& checkpoint : fs::directory_iterator(folder / "checkpoints"))
    EXPECT_FALSE(fs::exists(store.record(checkpoint.path().filename().string()))) << checkpoint.path();
}

TEST(StoreCrash, OnlyFoldersOfDeadProcessesAreRemoved) {
  const TemporaryFolder temporary;
  const fs::path folder = temporary.path() / "store";
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const auto work_until_killed = [&] {
    Store store(folder);
    std::ofstream(store.begin(crash_key(0)) / "half.csv") << "half";
    if (::write(ready[1], "+", 1) != 1) ::_exit(98);
    ::pause();
  };
  const pid_t dead = start(work_until_killed);
  const pid_t alive = start(work_until_killed);
  char bytes[2];
  for (int i = 0; i < 2; ++i) ASSERT_EQ(::read(ready[0], bytes, 1), 1);
  ::kill(dead, SIGKILL);
  status_of(dead);
  EXPECT_EQ(folders_in(folder / "tmp"), 2u);
  { const Store store(folder); }
  EXPECT_EQ(folders_in(folder / "tmp"), 1u);
  ::kill(alive, SIGKILL);
  status_of(alive);
  { const Store store(folder); }
  EXPECT_EQ(folders_in(folder / "tmp"), 0u);
  ::close(ready[0]);
  ::close(ready[1]);
}

TEST(StoreCrash, AFullDiskFailsTheCommitAndNothingElse) {
  const TemporaryFolder temporary;
  const fs::path folder = temporary.path() / "store";
  const pid_t child = start([&] {
    Store store(folder);
    commit(store, 0);
    const fs::path made = store.begin(crash_key(1));
    for (const auto& [name, content] : files_of(1)) std::ofstream(made / name) << content;
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit full{100, RLIM_INFINITY};  // the record does not fit
    ::setrlimit(RLIMIT_FSIZE, &full);
    ResultRecord record;
    record.key = crash_key(1);
    try {
      store.commit(made, record);
      ::_exit(1);
    } catch (const std::runtime_error& error) {
      const std::string message = error.what();
      if (message.find("cannot write " + folder.string()) == std::string::npos) ::_exit(2);
      if (message.find("File too large") == std::string::npos) ::_exit(3);
    }
    if (!check(store, 0) || check(store, 1)) ::_exit(4);
    const rlimit free{RLIM_INFINITY, RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &free);
    commit(store, 1);
    if (!check(store, 1)) ::_exit(5);
  });
  const int status = status_of(child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(check(StoreReader(folder), 0));
}

}  // namespace
}  // namespace coppice
