#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/vocabulary/dataset.h"
#include "engine/vocabulary/random.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

const Spaces kSpaces = {{{"position", "m", -1, 1}, {"speed", "m/s", -1, 1}},
                        {{"push", {{"force", "N", -1, 1}, {"angle", "rad", -3, 3}}}, {"wait", {}}}};

constexpr const char* kHeader =
    "episode,step,s_position,s_speed,action_id,a_force,a_angle,reward,n_position,n_speed,terminal\n";

Dataset sample_dataset() {
  Dataset dataset(kSpaces, 3);
  Stream stream = Draws(1, "dataset", 0).stream("numbers");
  for (std::size_t i = 0; i < 3; ++i) {
    dataset.episode[i] = static_cast<std::int64_t>(i / 2);
    dataset.step[i] = static_cast<std::int64_t>(i % 2);
    for (std::size_t c = 0; c < 2; ++c) {
      dataset.states(i, c) = stream.normal();
      dataset.next(i, c) = stream.normal();
    }
    dataset.reward[i] = stream.normal();
    dataset.set_action(i, {0, {stream.uniform(), stream.uniform()}});
  }
  Action wait;
  wait.id = 1;
  dataset.set_action(1, wait);
  dataset.terminal[1] = 1;
  return dataset;
}

void expect_equal(const Matrix& a, const Matrix& b) {
  ASSERT_EQ(a.values().size(), b.values().size());
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    EXPECT_TRUE(a.values()[i] == b.values()[i] || (std::isnan(a.values()[i]) && std::isnan(b.values()[i])));
  }
}

std::string dataset_error(const std::string& content) {
  const TemporaryFolder folder;
  try {
    read_dataset(folder.write("d.csv", content), kSpaces);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(DatasetFile, HasTheDocumentedColumns) {
  const TemporaryFolder folder;
  Dataset dataset(kSpaces, 1);
  dataset.set_action(0, {0, {0.5, -0.25}});
  dataset.reward[0] = -1.5;
  dataset.terminal[0] = 1;
  write_dataset(folder / "d.csv", dataset);
  EXPECT_EQ(TemporaryFolder::read(folder / "d.csv"),
            std::string(kHeader) + "0,0,0,0,0,0.5,-0.25,-1.5,0,0,1\n");
  EXPECT_NE(TemporaryFolder::read(folder / "d.schema.json").find("\"unit\": \"m/s\""), std::string::npos);
}

TEST(DatasetFile, ReadsBackToTheSameNumbers) {
  const TemporaryFolder folder;
  write_dataset(folder / "d.csv", sample_dataset());
  const Dataset back = read_dataset(folder / "d.csv", kSpaces);
  EXPECT_EQ(back.spaces, kSpaces);
  EXPECT_EQ(back.episode, sample_dataset().episode);
  EXPECT_EQ(back.step, sample_dataset().step);
  EXPECT_EQ(back.action_id, sample_dataset().action_id);
  EXPECT_EQ(back.reward, sample_dataset().reward);
  EXPECT_EQ(back.terminal, sample_dataset().terminal);
  expect_equal(back.states, sample_dataset().states);
  expect_equal(back.actions, sample_dataset().actions);
  expect_equal(back.next, sample_dataset().next);
}

TEST(DatasetFile, ColumnsStandInAnyOrderAndOthersAreSkipped) {
  const TemporaryFolder folder;
  const Dataset back = read_dataset(folder.write("d.csv",
                                                 "terminal,comment,n_speed,n_position,reward,a_angle,a_force,"
                                                 "action_id,s_speed,s_position,step,episode\r\n"
                                                 "true,\"a, b\",1,2,3,,,1,4,5,6,7\r\n"),
                                    kSpaces);
  EXPECT_EQ(back.states(0, 0), 5);
  EXPECT_EQ(back.states(0, 1), 4);
  EXPECT_EQ(back.next(0, 0), 2);
  EXPECT_EQ(back.action_id[0], 1);
  EXPECT_EQ(back.episode[0], 7);
  EXPECT_EQ(back.terminal[0], 1);
}

TEST(DatasetFile, MissingAndUnknownColumnsGetTheNearestName) {
  const std::string error = dataset_error(
      "episode,step,s_positoin,s_speed,action_id,a_force,a_angle,reward,n_position,n_speed,terminal\n");
  EXPECT_NE(error.find("the column 's_position' is missing"), std::string::npos) << error;
  EXPECT_NE(error.find("did you mean 's_positoin'"), std::string::npos) << error;
  EXPECT_NE(error.find("d.csv:1:14: error: the problem has no axis 's_positoin'"), std::string::npos)
      << error;
}

TEST(DatasetFile, BadCellsAreLocatedAllInOnePass) {
  const std::string error = dataset_error(std::string(kHeader) +
                                          "0,0,nan,0,0,0,0,0,0,0,0\n"
                                          "0,1.5,0,0,0,0,0,0,0,0,0\n"
                                          "-1,2,0,0,0,0,0,0,0,0,0\n"
                                          "0,3,0,0,2,0,0,0,0,0,0\n"
                                          "0,4,0,0,0,,0,0,0,0,0\n"
                                          "0,5,0,0,1,1,,0,0,0,0\n"
                                          "0,6,0,0,0,0,0,,0,0,0\n"
                                          "0,7,0,0,0,0,0,0,0,inf,2\n");
  for (const char* expected :
       {"d.csv:2:5: error: 's_position': 'nan' is not a finite number",
        "d.csv:3:3: error: 'step': '1.5' is not a whole number from 0",
        "d.csv:4:1: error: 'episode': '-1' is not a whole number from 0",
        "d.csv:5:9: error: there is no action 2",
        "d.csv:6:11: error: 'a_force' must have a number for action 0 ('push', 2 parameters)",
        "d.csv:7:11: error: 'a_force' must be empty for action 1 ('wait', 0 parameters)",
        "d.csv:8:15: error: 'reward': '' is not a finite number",
        "d.csv:9:19: error: 'n_speed': 'inf' is not a finite number",
        "d.csv:9:23: error: 'terminal': '2' is not 0 or 1"}) {
    EXPECT_NE(error.find(expected), std::string::npos) << expected << "\nin\n" << error;
  }
}

TEST(DatasetFile, StopsAfterManyMistakes) {
  std::string content = kHeader;
  for (int i = 0; i < 1000; ++i) content += "x,0,0,0,0,0,0,0,0,0,0\n";
  const std::string error = dataset_error(content);
  std::size_t count = 0;
  for (std::size_t at = error.find("error:"); at != std::string::npos; at = error.find("error:", at + 1))
    ++count;
  EXPECT_EQ(count, 20u);
}

TEST(DatasetFile, BadFilesAreRefused) {
  EXPECT_NE(dataset_error("").find("empty"), std::string::npos);
  EXPECT_NE(dataset_error(std::string("\x7f"
                                      "ELF\0\0",
                                      6))
                .find("binary"),
            std::string::npos);
  EXPECT_NE(dataset_error(std::string(kHeader) + "0,0,0\n")
                .find("2:5: error: the row has 3 cells, the header has 11"),
            std::string::npos);
}

TEST(DatasetFile, WithoutRowsIsRefused) {
  EXPECT_NE(dataset_error(kHeader).find("d.csv:1:1: error: there are no rows below the header"),
            std::string::npos);
}

TEST(DatasetFile, OtherSeparatorsAreNamed) {
  EXPECT_NE(dataset_error("episode;step;s_position\n0;0;0\n").find("fields are separated by commas"),
            std::string::npos);
}

TEST(DatasetFile, ActionsOutsideTheirBoxesAreRefused) {
  const std::string error = dataset_error(std::string(kHeader) +
                                          "0,0,0,0,0,1.00000001,-3,0,0,0,0\n"
                                          "0,1,0,0,0,57.3,0,0,0,0,0\n");
  EXPECT_EQ(error.find("d.csv:2"), std::string::npos) << error;
  EXPECT_NE(error.find("d.csv:3:11: error: 'a_force' is 57.3, and this action's is in [-1, 1] N"),
            std::string::npos)
      << error;
}

TEST(DatasetFile, RowsOutOfOrderAreRefused) {
  const std::string error = dataset_error(std::string(kHeader) +
                                          "0,0,0,0,1,,,0,0,0,0\n"
                                          "0,2,0,0,1,,,0,0,0,0\n"
                                          "0,2,0,0,1,,,0,0,0,0\n"
                                          "3,5,0,0,1,,,0,0,0,1\n"
                                          "3,6,0,0,1,,,0,0,0,0\n"
                                          "2,0,0,0,1,,,0,0,0,0\n");
  for (const char* expected : {"d.csv:4:3: error: step 2 of episode 0 stands below step 2",
                               "d.csv:6:3: error: episode 3 goes on after a terminal step",
                               "d.csv:7:1: error: episode 2 stands below episode 3"}) {
    EXPECT_NE(error.find(expected), std::string::npos) << expected << "\nin\n" << error;
  }
}

TEST(ReadStates, ReadsTheStateColumns) {
  const auto text = std::make_shared<SourceFile>(SourceFile{"<stdin>", "s_speed,s_position\n1,2\n3,4\n"});
  const Matrix states = read_states(text, kSpaces.states);
  ASSERT_EQ(states.rows(), 2u);
  EXPECT_EQ(states(0, 0), 2);
  EXPECT_EQ(states(1, 1), 3);
  const auto wrong = std::make_shared<SourceFile>(SourceFile{"<stdin>", "s_speed\n1\n"});
  EXPECT_THROW(read_states(wrong, kSpaces.states), ConfigError);
}

}  // namespace
}  // namespace coppice
