#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <ostream>

#include "tests/cli/runs.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

const std::string kConfigHead =
    "<experiment coppice=\"1\" name=\"e\" seed=\"3\"><problem id=\"car\"><double_integrator/></problem>"
    "<policy id=\"any\"><random/></policy>";
const std::string kColumns =
    "episode,step,s_position,s_speed,action_id,a_acceleration,reward,n_position,n_speed,terminal\n";
const std::string kRow = "0,0,1,0,0,0.5,-1,1,0.025,0\n";

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

/// No bad input may take long or much memory (in kB of address space, of which the sanitizer takes all).
const std::string kGuard = kSanitized ? "timeout 100 " : "ulimit -v 3000000; timeout 20 ";

class BadInput : public RunsInAFolder {
 protected:
  Ended guarded(const std::string& arguments) const { return script(kGuard + "$RUNNER " + arguments); }
  void write(const std::string& nodes, const std::string& file = "e.xml") const {
    folder_.write(file, kConfigHead + nodes + "</experiment>");
  }
  /// The config is refused with one message that has all parts, and nothing is made.
  void refused(const std::string& file, const std::vector<std::string>& parts) const {
    for (const std::string command : {"validate ", "run --out made "}) {
      const Ended ended = guarded(command + file);
      EXPECT_EQ(ended.status, 2) << file << "\n" << ended.err.substr(0, 2000);
      EXPECT_EQ(ended.out, "");
      for (const std::string& part : parts)
        EXPECT_TRUE(contains(ended.err, part)) << part << " not in\n" << ended.err.substr(0, 2000);
      EXPECT_FALSE(fs::exists(folder_ / "made")) << file;
    }
  }
};

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

TEST_F(BadInput, ThatIsEnormousIsRefusedQuickly) {
  struct Case {
    std::string name, text, message;
  };
  for (const Case& enormous :
       {Case{"deep",
             kConfigHead + repeated("<group>", 100'000) + repeated("</group>", 100'000) + "</experiment>",
             "nested more than 90 deep"},
        Case{"unclosed", kConfigHead + repeated("<group>", 100'000), "nested more than 90 deep"},
        Case{"value",
             kConfigHead + "<evaluate id=\"e\" problem=\"car\" policies=\"any\" episodes=\"" +
                 std::string(50'000'000, '9') + "\"/></experiment>",
             "bytes left out"},
        Case{"file", std::string(70'000'000, ' '), "larger than 64 MiB"},
        Case{"attributes",
             "<experiment coppice=\"1\" " +
                 [] {
                   std::string all;
                   for (int i = 0; i < 100'000; ++i) all += " a" + std::to_string(i) + "=\"1\"";
                   return all;
                 }() +
                 "/>",
             "more than 1000 attributes"},
        Case{"mistakes", kConfigHead + repeated("<bogus/>\n", 100'000) + "</experiment>", "1000 errors"},
        Case{"mistakes_in_a_line", kConfigHead + repeated("<bogus/>", 100'000) + "</experiment>",
             "1000 errors"},
        Case{"ampersands", "<experiment coppice=\"1\" doc=\"" + std::string(1'000'000, '&') + "\"/>",
             "'&' by itself"},
        Case{"less_than", "<experiment coppice=\"1\" doc=\"" + std::string(1'000'000, '<') + "\"/>",
             "'<' inside"},
        Case{"parentheses",
             kConfigHead + "<let name=\"a\" value=\"${" + std::string(1'000'000, '(') + "}\"/></experiment>",
             "100 levels deep"},
        Case{"operators",
             kConfigHead + "<let name=\"a\" value=\"${" + repeated("1+", 1'000'000) + "1}\"/></experiment>",
             "1000 operators"}}) {
    SCOPED_TRACE(enormous.name);
    const std::string file = enormous.name + ".xml";
    folder_.write(file, enormous.text);
    const Ended ended = guarded("validate " + file);
    EXPECT_EQ(ended.status, 2) << ended.err.substr(0, 1000);
    EXPECT_EQ(ended.out, "");
    EXPECT_TRUE(contains(ended.err, file + ":") || contains(ended.err, file + " "))
        << ended.err.substr(0, 1000);
    EXPECT_TRUE(contains(ended.err, enormous.message)) << ended.err.substr(0, 1000);
    EXPECT_LT(ended.err.size(), 1'000'000U);
  }
}

TEST_F(BadInput, ThatGrowsIsRefusedQuickly) {
  std::string macros = "<macro name=\"m0\" params=\"a\"><group/></macro>",
              lets = "<let name=\"a0\" value=\"xxxxxxxxxx\"/>";
  for (int i = 1; i <= 12; ++i) {
    const std::string last = std::to_string(i - 1), now = std::to_string(i);
    macros += "<macro name=\"m" + now + "\" params=\"a\">" +
              repeated("<call macro=\"m" + last + "\" a=\"1\"/>", 10) + "</macro>";
    lets += "<let name=\"a" + now + "\" value=\"" + repeated("${a" + last + "}", 10) + "\"/>";
  }
  write(macros + "<call macro=\"m12\" a=\"1\"/>");
  refused("e.xml", {"2000000 elements"});
  write(lets);
  refused("e.xml", {"grows beyond 1048576 bytes"});
  write("<macro name=\"m\"><call macro=\"m\"/></macro><call macro=\"m\"/>");
  refused("e.xml", {"50 levels deep"});
  write("<collect id=\"c\" problem=\"car\" policy=\"any\" episodes=\"5\" replicates=\"10000000\"/>");
  refused("e.xml", {"more than 1000000 nodes"});
  write("<sweep id=\"s\"><grid><param name=\"a\" values=\"${range(1, 1e12, 1)}\"/></grid></sweep>");
  refused("e.xml", {"more than 1000000 items"});
  write("<include file=\"e.xml\"/>");
  refused("e.xml", {"include each other in a circle"});
}

TEST_F(BadInput, FilesThatAreNone) {
  ASSERT_EQ(script("mkdir folder; mkfifo pipe; ln -s nowhere link; ln -s loop loop").status, 0);
  struct Case {
    std::string file, message;
  };
  for (const Case& wrong : {Case{"folder", "folder, not a file"}, Case{"pipe", "pipe or a device"},
                            Case{"/dev/zero", "pipe or a device"}, Case{"link", "no file 'link'"},
                            Case{"loop", "loop"}, Case{"nowhere/x", "no folder"}}) {
    SCOPED_TRACE(wrong.file);
    write("<dataset id=\"d\" problem=\"car\" file=\"" + wrong.file + "\"/>");
    refused("e.xml", {"e.xml:1:", wrong.message});
    write("<policy id=\"p\" file=\"" + wrong.file +
          "\"/><evaluate id=\"s\" problem=\"car\" policies=\"p\" episodes=\"1\"/>");
    refused("e.xml", {"e.xml:1:", wrong.message});
    const Ended ended = guarded("policy info " + wrong.file + " < /dev/null");
    EXPECT_EQ(ended.status, 2) << ended.err;
  }
  refused("folder", {"folder, not a file"});
  refused("/dev/zero", {"larger than 64 MiB"});
  write("<include file=\"/dev/zero\"/>");
  refused("e.xml", {"larger than 64 MiB"});
}

TEST_F(BadInput, UnreadableFiles) {
  write("<dataset id=\"d\" problem=\"car\" file=\"d.csv\"/>");
  folder_.write("d.csv", kColumns + kRow);
  // Root may read everything: the program runs as somebody who may not.
  const bool root = ::geteuid() == 0;
  if (root && script("command -v setpriv").status != 0)
    GTEST_SKIP() << "setpriv is needed to become somebody else";
  const std::string as_somebody = root ? "setpriv --reuid 65534 --clear-groups " : "";
  if (root && script(as_somebody + "$RUNNER --version").status != 0)
    GTEST_SKIP() << "only root may run the program here";
  ASSERT_EQ(script("chmod 755 .; chmod 0 d.csv; mkdir mine; chmod 777 mine").status, 0);
  const auto attempt = [&](const std::string& arguments) {
    return script(as_somebody + "$RUNNER " + arguments);
  };
  const Ended data = attempt("e.xml --out mine/out");
  EXPECT_EQ(data.status, 2) << data.err;
  EXPECT_TRUE(contains(data.err, "e.xml:1:")) << data.err;
  EXPECT_TRUE(contains(data.err, "d.csv: Permission denied")) << data.err;
  ASSERT_EQ(script("chmod 644 d.csv; chmod 0 e.xml").status, 0);
  const Ended config = attempt("e.xml --out mine/out");
  EXPECT_EQ(config.status, 2) << config.err;
  EXPECT_TRUE(contains(config.err, "e.xml: error: cannot read the file: Permission denied")) << config.err;
  ASSERT_EQ(script("chmod 644 e.xml; chmod 555 mine").status, 0);
  const Ended folder = attempt("e.xml --out mine/out");
  EXPECT_EQ(folder.status, 2) << folder.err;
  EXPECT_TRUE(contains(folder.err, "mine/out") && contains(folder.err, "Permission denied")) << folder.err;
  ASSERT_EQ(script("chmod 777 mine").status, 0);
  EXPECT_EQ(attempt("e.xml --out mine/out").status, 0);
}

TEST_F(BadInput, DatasetsAreRefusedWithTheCell) {
  struct Case {
    std::string csv, message;
    int status = 1;  ///< rows are read when the node runs, the header when it is planned
  };
  const auto with = [](const std::string& row) { return kColumns + kRow + row; };
  for (const Case& wrong :
       {Case{"", "the file is empty", 2}, Case{std::string("\0\1\2", 3), "binary", 2},
        Case{with("0,0,nan,0,0,0.5,-1,1,0.025,0\n"),
             ":3:5: error: 's_position': 'nan' is not a finite number"},
        Case{with("0,0,1,0,0,inf,-1,1,0.025,0\n"), ":3:11: error: 'a_acceleration': 'inf'"},
        Case{with("0,0,1e999,0,0,1,-1,1,0.025,0\n"), ":3:5: error: 's_position': '1e999'"},
        Case{with("-1,0,1,0,0,0.5,-1,1,0.025,0\n"), ":3:1: error: 'episode': '-1' is not a whole number"},
        Case{with("0,0,1,0,7,0.5,-1,1,0.025,0\n"), ":3:9: error: there is no action 7"},
        Case{with("0,0,1,0,0,0.5\n"), "the row has 6 cells, the header has 10"},
        Case{with("\"0,0,1\n"), "the quote is not closed"},
        Case{"episode,step\n", "the column 'reward' is missing", 2}, Case{"episode,\xff\n", "not UTF-8", 2},
        Case{"episode,episode\n", "stands twice", 2}}) {
    SCOPED_TRACE(wrong.message);
    write("<dataset id=\"d\" problem=\"car\" file=\"d.csv\"/>");
    folder_.write("d.csv", wrong.csv);
    const Ended ended = guarded("e.xml --progress none");
    EXPECT_EQ(ended.status, wrong.status);
    const Ended told = guarded("e.xml --progress plain");
    EXPECT_EQ(told.status, wrong.status);
    EXPECT_TRUE(contains(told.err, "d.csv")) << told.err;
    EXPECT_TRUE(contains(told.err, wrong.message)) << told.err;
    EXPECT_EQ(told.err.find('\xff'), std::string::npos);
  }
}

TEST_F(BadInput, HugeSizesFailBeforeTheMemoryIsFull) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer ends the program where memory runs out";
  for (const std::string node :
       {"<collect id=\"n\" problem=\"car\" policy=\"any\" episodes=\"5000000000000000000\"/>",
        "<collect id=\"n\" problem=\"car\" policy=\"any\" episodes=\"1e14\"/>",
        "<collect id=\"n\" problem=\"car\" samples=\"5000000000000000000\"/>",
        "<collect id=\"n\" problem=\"car\" samples=\"1e14\"/>",
        "<evaluate id=\"n\" problem=\"car\" policies=\"any\" episodes=\"5000000000000000000\"/>",
        "<evaluate id=\"n\" problem=\"car\" policies=\"any\" episodes=\"1e14\"/>"}) {
    SCOPED_TRACE(node);
    write(node);
    const Ended ended = guarded("e.xml --progress plain");
    EXPECT_EQ(ended.status, 1) << ended.err;
    EXPECT_TRUE(contains(ended.err, "memory")) << ended.err;
  }
}

TEST_F(BadInput, ClosedStreamsLeaveFilesAlone) {
  write(
      "<evaluate id=\"s\" problem=\"car\" policies=\"any\" episodes=\"3\"/><table id=\"t\" of=\"s\" "
      "rows=\"policy\" metric=\"cost\"/>");
  ASSERT_EQ(run("e.xml --out calm").status, 0);
  const auto expected = results(folder_ / "calm/e");
  struct Case {
    std::string closed;
    bool said;  // the paths of tables and page, which go to stdout, cannot be written
  };
  for (const Case& given :
       {Case{">&-", true}, Case{"2>&-", false}, Case{"<&-", false}, Case{"<&- >&- 2>&-", false},
        Case{"> /dev/full", true}, Case{"2> /dev/full", false}, Case{"| true", false}}) {
    SCOPED_TRACE(given.closed);
    for (const std::string progress : {"plain", "json"}) {
      script("rm -rf out");
      const Ended ended = script("set -o pipefail; runner e.xml --progress " + progress + " " + given.closed);
      EXPECT_EQ(ended.status, 0) << "all nodes are done";
      EXPECT_EQ(contains(ended.err, "warning: cannot write to standard output: "), given.said) << ended.err;
      EXPECT_EQ(results(folder_ / "out/e"), expected);
      // The first files opened would get the numbers of the closed streams, and the talk with them.
      const std::string owner = TemporaryFolder::read(folder_ / "out/e/.coppice/lock");
      EXPECT_EQ(owner.find_first_not_of("0123456789"), owner.npos) << owner;
      EXPECT_EQ(TemporaryFolder::read(folder_ / "out/store/lock"), "");
      for (const std::string& line : lines(TemporaryFolder::read(folder_ / "out/e/events.jsonl"))) {
        EXPECT_TRUE(nlohmann::json::accept(line) && contains(line, "\"time\"")) << line;
      }
      EXPECT_TRUE(contains(run("e.xml").err, "everything is up to date"));
      EXPECT_TRUE(contains(script("head -c 15 out/index.sqlite").out, "SQLite format 3"));
    }
  }
  folder_.write("bad.csv",
                "episode,step,s_position,s_speed,action_id,a_acceleration,reward,n_position,n_speed,"
                "terminal\n");
  write("<dataset id=\"s\" problem=\"car\" file=\"bad.csv\"/>");  // no rows: found when it runs
  for (const std::string closed : {"> paths", ">&-", "> /dev/full", "| true"})
    EXPECT_EQ(script("set -o pipefail; runner e.xml --out failed " + closed).status, 1) << closed;
  for (const std::string command : {"list", "schema", "expand e.xml", "plan e.xml", "status", "--help"}) {
    EXPECT_EQ(script("runner " + command + " >&-").status, 1) << command;
    EXPECT_EQ(script("runner " + command + " > /dev/full").status, 1) << command;
    EXPECT_EQ(script("set -o pipefail; runner " + command + " | head -1").status, 0) << command;
    EXPECT_EQ(script("set -o pipefail; runner " + command + " | true").status, 0) << command;
    EXPECT_EQ(script("runner " + command + " <&-").status, 0) << command;
    EXPECT_EQ(script("runner " + command + " 2>&- > /dev/null").status, 0) << command;
  }
}

/// Of what lies in the output folder, only the store and the run folders matter; whatever happened to a file,
/// the next run goes on or names it.
TEST_F(BadInput, DamagedOutputFoldersAreMended) {
  write(
      "<evaluate id=\"s\" problem=\"car\" policies=\"any\" episodes=\"3\"/><table id=\"t\" of=\"s\" "
      "rows=\"policy\" metric=\"cost\"/>");
  ASSERT_EQ(run("e.xml --out whole").status, 0);
  const auto expected = results(folder_ / "whole/e");
  for (const std::string file : {"index.sqlite", "e/events.jsonl", "e/provenance.json",
                                 "e/.coppice/placements", "e/.coppice/lock", "store/lock"}) {
    for (const std::string damage : {"head -c 5000 /dev/urandom >", ": >", "rm ", "truncate -s 100 "}) {
      SCOPED_TRACE(damage + file);
      ASSERT_EQ(script("rm -rf out; cp -a whole out; " + damage + " out/" + file).status, 0);
      for (const std::string command : {"status", "plan e.xml", "why s e.xml"}) {
        const Ended ended = run(command);
        EXPECT_EQ(ended.status, 0) << command << "\n" << ended.err;
      }
      EXPECT_EQ(run("e.xml").status, 0);
      EXPECT_EQ(results(folder_ / "out/e"), expected);
      EXPECT_EQ(run("e.xml --seed 4").status, 0);
      EXPECT_EQ(run("e.xml").status, 0);
      EXPECT_EQ(results(folder_ / "out/e"), expected);
    }
  }
}

TEST_F(BadInput, TemporaryFilesOfKilledRunsAreRemoved) {
  write(
      "<evaluate id=\"s\" problem=\"car\" policies=\"any\" episodes=\"3\"/>"
      "<table id=\"t\" of=\"s\" rows=\"policy\" metric=\"cost\"/>");
  ASSERT_EQ(run("e.xml").status, 0);
  const auto expected = results(folder_ / "out/e");
  for (const std::string name : {".resolved.xml.7.0.tmp", "nodes/.s.csv.7.1.tmp", "tables/.t.csv.7.2.tmp"}) {
    folder_.write("out/e/" + name, "half");
  }
  folder_.write("out/e/mine.tmp", "not the program's");
  EXPECT_TRUE(contains(run("e.xml").err, "everything is up to date"));
  EXPECT_EQ(TemporaryFolder::read(folder_ / "out/e/mine.tmp"), "not the program's");
  fs::remove(folder_ / "out/e/mine.tmp");
  std::size_t left = 0;  // results() leaves out hidden names
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out/e")) {
    left += entry.path().extension() == ".tmp" ? 1 : 0;
  }
  EXPECT_EQ(left, 0U);
  EXPECT_EQ(results(folder_ / "out/e"), expected);
}

TEST_F(BadInput, PolicyFilesOfEveryKindOfDamage) {
  write(
      "<collect id=\"c\" problem=\"car\" policy=\"any\" episodes=\"20\"/>"
      "<train id=\"t\" problem=\"car\" samples=\"c\"><fqi iterations=\"2\"/></train>");
  ASSERT_EQ(run("e.xml").status, 0);
  const std::string whole = TemporaryFolder::read(folder_ / "out/e/nodes/t/policy.policy");
  ASSERT_GT(whole.size(), 100U);
  folder_.write("user.xml",
                kConfigHead +
                    "<policy id=\"p\" file=\"x.policy\"/>"
                    "<evaluate id=\"s\" problem=\"car\" policies=\"p\" episodes=\"2\"/></experiment>");
  std::string newer = whole;
  newer[8] = 9;  // the version follows the magic number
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 1;
  struct Case {
    std::string bytes, message;
  };
  for (const Case& wrong : {Case{"", "not a policy file"}, Case{whole.substr(0, 12), "truncated"},
                            Case{whole.substr(0, whole.size() - 1), "truncated"}, Case{flipped, "damaged"},
                            Case{whole + "x", "damaged"}, Case{newer, "a newer program wrote"},
                            Case{kColumns + kRow, "not a policy file"}}) {
    SCOPED_TRACE(wrong.message);
    folder_.write("x.policy", wrong.bytes);
    for (const std::string command : {"policy info x.policy", "policy act x.policy < /dev/null",
                                      "policy evaluate x.policy --problem double_integrator --episodes 1",
                                      "plan user.xml", "run user.xml"}) {
      const Ended ended = guarded(command);
      EXPECT_EQ(ended.status, 2) << command;
      EXPECT_EQ(ended.out, "");
      EXPECT_TRUE(contains(ended.err, "x.policy")) << ended.err;
      const std::size_t said = ended.err.find(wrong.message);
      EXPECT_NE(said, std::string::npos) << command << "\n" << ended.err;
      EXPECT_EQ(ended.err.find(wrong.message, said + 1), std::string::npos) << "twice\n" << ended.err;
    }
  }
}

/// A signal of either kind, whatever runs: status 3, and the same command ends with the same bytes.
TEST_F(BadInput, SignalsInterruptAndTheSameCommandGoesOn) {
  const std::string collect = "<collect id=\"c\" problem=\"car\" policy=\"any\" episodes=\"40\"/>";
  write(collect + "<train id=\"t\" problem=\"car\" samples=\"c\"><fqi iterations=\"150\"/></train>",
        "train.xml");
  write(collect +
            "<train id=\"t\" problem=\"car\" samples=\"c\" time_limit=\"1 h\"><fqi "
            "iterations=\"150\"/></train>",
        "process.xml");
  ASSERT_EQ(run("train.xml --out calm").status, 0);
  const auto expected = results(folder_ / "calm/e/nodes");
  for (const std::string config : {"train.xml", "process.xml"}) {
    for (const std::string signals : {"kill -INT $pid", "kill -TERM $pid", "kill -INT $pid; kill -INT $pid",
                                      "kill -TERM $pid; kill -INT $pid"}) {
      SCOPED_TRACE(config + ": " + signals);
      script("rm -rf out log");  // an old log would say at once that t has started
      const Ended ended = script("$RUNNER " + config +
                                 " --progress json > paths 2> log & pid=$!\n"
                                 "until grep -q '\"started\".*\"t\"' log; do sleep 0.01; done; sleep 0.1\n" +
                                 signals + "; wait $pid; echo status $?");
      EXPECT_EQ(ended.out, "status 3\n") << ended.err << TemporaryFolder::read(folder_ / "log");
      EXPECT_EQ(run(config).status, 0);
      EXPECT_EQ(results(folder_ / "out/e/nodes"), expected);
    }
  }
}

}  // namespace
}  // namespace coppice
