#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include "engine/graph/report.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A run folder made by hand, with names that are markup.
class PageTest : public ::testing::Test {
 protected:
  PageTest() {
    folder = context.folder() / "tricky";
    std::filesystem::create_directories(folder / "tables");
    std::filesystem::create_directories(folder / "figures");
    put("resolved.xml",
        R"(<experiment coppice="1" name="tricky" seed="7" doc="Costs &lt; 1 &amp; &quot;more&quot;">
             <problem id="car"><double_integrator/></problem>
             <policy id="lqr"><linear_feedback gains="0.687, 1.177"/></policy>
             <evaluate id="scores" problem="car" policies="lqr" episodes="1" doc="What it costs"/>
             <table id="costs" of="scores" rows="policy" columns="problem" metric="cost"
                    doc="All &lt;costs&gt;"/>
             <table id="plain" of="scores" rows="policy" metric="cost"/>
           </experiment>)");
    put("provenance.json",
        R"({"config": "a<b>.xml", "command": ["a<b>.xml"], "overrides": {"scale": "ci"},
            "arguments": {"scale": "ci", "n": "3"}, "threads": 2, "started": "2026-01-02T03:04:05.000Z",
            "finished": "2026-01-02T03:04:06.000Z", "outcome": "failed",
            "inputs": [{"path": "a<b>.xml", "hash": "00ff"}], "environment": {"coppice": "1.2.3"}})");
    put("events.jsonl", R"({"time":"2026-01-02T03:04:05.000Z","event":"failed","node":"scores lqr",)"
                        R"("message":"<boom> & \"bust\""})"
                        "\n");
    const std::string csv =
        "policy,problem,n_replicates,episodes,mean,ci95_low,ci95_high,iqm,worst,best,published,reference\n"
        "lqr,car,4,10,3.42268123,3.4,3.5,3.42,3.6,3.3,3.423,\n"
        "<i>fpf</i>,car,4,10,4,,,4,4,4,,\n";
    put("tables/costs.csv", csv);
    put("tables/plain.csv", csv);
    put("figures/odd.csv", "x\n1,2\n");  // not a table
    write_reports(folder);
    page = text_of(folder / "report.html");
  }
  void put(const std::string& name, const std::string& text) { write_file(folder / name, text); }

  FakeContext context;
  std::filesystem::path folder;
  std::string page;
};

TEST_F(PageTest, IsWellFormedWhateverTheNames) {
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(page.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  EXPECT_THAT(page,
              AllOf(HasSubstr("Costs &lt; 1 &amp; &quot;more&quot;"), HasSubstr("&lt;i&gt;fpf&lt;/i&gt;"),
                    HasSubstr("&lt;boom&gt; &amp; &quot;bust&quot;"), HasSubstr("a&lt;b&gt;.xml")));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("<i>fpf")), Not(HasSubstr("<boom>")), Not(HasSubstr("a<b>"))));
}

TEST_F(PageTest, NeedsNothingButItself) {
  EXPECT_THAT(page, AllOf(Not(HasSubstr("<script")), Not(HasSubstr("<link")), Not(HasSubstr("src=")),
                          Not(HasSubstr("url(")), Not(HasSubstr("@import"))));
  EXPECT_THAT(page, AllOf(HasSubstr("prefers-color-scheme: dark"), HasSubstr("@media print")));
}

TEST_F(PageTest, SpreadsTablesOutByTheirKeys) {
  EXPECT_THAT(page, AllOf(HasSubstr("<small>problem</small>car"), HasSubstr("<strong>3.4227</strong>"),
                          HasSubstr("[3.4, 3.5]"), HasSubstr("n = 4 · published 3.423"),
                          HasSubstr("<a href=\"tables/costs.csv\">")));
}

TEST_F(PageTest, ShowsTablesWithoutColumnKeysAsTheyAre) {
  EXPECT_THAT(page, AllOf(HasSubstr("<h3>plain: cost</h3>"), HasSubstr(">ci95_low</th>"),
                          HasSubstr("<td class=\"number\">3.423</td>")));
}

TEST_F(PageTest, SaysWhatFailedAndWhatIsMissing) {
  EXPECT_THAT(page,
              AllOf(HasSubstr("3 nodes: 0 done, 1 failed, 2 missing."), HasSubstr("<h3>scores lqr</h3>"),
                    HasSubstr("<td class=\"failed\">failed</td>"), HasSubstr("What it costs")));
}

TEST_F(PageTest, SaysWhereResultsComeFrom) {
  EXPECT_THAT(page,
              AllOf(HasSubstr("seed 7 · scale:=ci · failed"), HasSubstr("<dt>coppice</dt><dd>1.2.3</dd>"),
                    HasSubstr("00ff"), HasSubstr("runner a&lt;b&gt;.xml")));
}

TEST_F(PageTest, ShowsWhyATableCannotBeRead) {
  EXPECT_THAT(page, HasSubstr("odd.csv:2"));
}

TEST(Page, RefusesAFolderThatIsNotOfARun) {
  FakeContext context;
  EXPECT_THAT(error_of([&] { write_reports(context.folder()); }), HasSubstr("not the folder of a run"));
}

}  // namespace
}  // namespace coppice::testing
