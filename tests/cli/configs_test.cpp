#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/process.h"
#include "tests/support/places.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

const fs::path kRepository = source_folder();

std::vector<fs::path> xml_files(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".xml") found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

Ended xmllint(const fs::path& schema, const fs::path& file) {
  return shell("xmllint --noout --nonet --schema " + schema.string() + " " + file.string());
}

TEST(ShippedConfigs, AreValid) {
  for (const fs::path& file : xml_files(kRepository / "configs")) {
    const Ended ended = runner("validate " + file.string());
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.out, "");
  }
}

TEST(ShippedConfigs, PassXmllintBeforeAndAfterExpansion) {
  ASSERT_EQ(shell("command -v xmllint").status, 0) << "libxml2-utils is needed";
  const TemporaryFolder folder;
  const fs::path schema = folder.write("coppice.xsd", runner("schema").out);
  for (const fs::path& file : xml_files(kRepository / "configs")) {
    const Ended plain = xmllint(schema, file);
    EXPECT_EQ(plain.status, 0) << plain.err;
    const Ended expanded = runner("expand " + file.string());
    ASSERT_EQ(expanded.status, 0) << expanded.err;
    const Ended flat = xmllint(schema, folder.write("flat.xml", expanded.out));
    EXPECT_EQ(flat.status, 0) << file << "\n" << flat.err;
    EXPECT_EQ(runner("expand " + (folder / "flat.xml").string()).out, expanded.out) << file;
  }
}

TEST(Schema, RefusesWhatTheProgramRefuses) {
  const TemporaryFolder folder;
  const fs::path schema = folder.write("coppice.xsd", runner("schema").out);
  const auto config = [&](const std::string& problem) {
    return folder.write("config.xml",
                        "<experiment coppice=\"1\"><problem id=\"p\">" + problem + "</problem></experiment>");
  };
  EXPECT_EQ(xmllint(schema, config("<double_integrator/>")).status, 0);
  for (const std::string wrong :
       {"<double_integrater/>", "<double_integrator cots=\"p2_a2\"/>", "<double_integrator cost=\"p3\"/>",
        "<double_integrator discount=\"2\"/>"}) {
    EXPECT_NE(xmllint(schema, config(wrong)).status, 0) << wrong;
    EXPECT_EQ(runner("validate " + (folder / "config.xml").string()).status, 2) << wrong;
  }
}

/// Each tests/configs/broken/<name>.xml has a <name>.txt: every line of it must be part of what is said.
TEST(BrokenConfigs, AreRefusedWithHelpfulMessages) {
  std::size_t count = 0;
  for (const fs::path& file : xml_files(kRepository / "tests/configs/broken")) {
    fs::path expected = file;
    expected.replace_extension(".txt");
    if (!fs::exists(expected)) continue;  // a part that another file includes
    SCOPED_TRACE(file.string());
    ++count;
    const Ended ended = runner("validate " + fs::relative(file, kRepository).string());
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(ended.out, "");
    for (const std::string& line : lines(TemporaryFolder::read(expected))) {
      EXPECT_TRUE(contains(ended.err, line)) << "not said: " << line << "\n" << ended.err;
    }
  }
  EXPECT_GE(count, 60U);
}

TEST(Validate, ReportsTheMistakesOfAllFilesAtOnce) {
  const TemporaryFolder folder;
  folder.write("a.xml",
               "<experiment coppice=\"1\"><problem id=\"p\"><double_integrater/></problem></experiment>");
  folder.write("b.xml",
               "<experiment coppice=\"1\"><problem id=\"p\"><double_integrator cots=\"1\"/></problem>\n"
               "<evaluate id=\"e\" problem=\"q\" policies=\"r\" episodes=\"0\"/></experiment>");
  const Ended text = runner("validate a.xml b.xml c.xml", folder.path());
  EXPECT_EQ(text.status, 2);
  EXPECT_EQ(text.out, "");
  for (const std::string part : {"a.xml:1:", "did you mean 'double_integrator'?",
                                 "b.xml:1:", "did you mean 'cost'", "b.xml:2:", "'c.xml'"}) {
    EXPECT_TRUE(contains(text.err, part)) << part << " not in\n" << text.err;
  }
  const Ended json = runner("validate a.xml b.xml c.xml --format json", folder.path());
  EXPECT_EQ(json.status, 2);
  EXPECT_EQ(json.err, "");
  const nlohmann::json report = nlohmann::json::parse(json.out);
  EXPECT_FALSE(report.at("valid").get<bool>());
  ASSERT_GE(report.at("errors").size(), 4U);
  bool found = false;
  for (const nlohmann::json& error : report.at("errors")) {
    found = found || (error.at("file") == "a.xml" && error.at("line") == 1 && error.at("column") == 42 &&
                      contains(error.at("message"), "double_integrater"));
  }
  EXPECT_TRUE(found) << json.out;
}

TEST(Validate, RefusesFilesThatAreNoConfigs) {
  const TemporaryFolder folder;
  folder.write("empty.xml", "");
  folder.write("binary.xml", std::string("\0\x01\x02\xff<experiment/>", 17));
  folder.write("text.xml", "no markup at all");
  folder.write("half.xml", "<experiment coppice=\"1\"><problem id=");
  folder.write("newer.xml", "<experiment coppice=\"2\"/>");
  for (const std::string name : {"empty", "binary", "text", "half", "newer", "missing"}) {
    const Ended ended = runner("validate " + name + ".xml", folder.path());
    EXPECT_EQ(ended.status, 2) << name;
    EXPECT_TRUE(contains(ended.err, name + ".xml")) << ended.err;
    EXPECT_TRUE(contains(ended.err, "error: ")) << ended.err;
  }
  EXPECT_EQ(runner("validate " + folder.path().string()).status, 2);
}

TEST(Expand, WritesOneWellFormedFileForEachConfig) {
  const Ended ended = runner("expand configs/quickstart.xml replicates:=7");
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
  EXPECT_TRUE(contains(ended.out, "replicates=\"7\""));
  EXPECT_FALSE(contains(ended.out, "${"));
}

}  // namespace
}  // namespace coppice
