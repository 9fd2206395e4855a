// What compare_trees.py measures of this project's forests, as commands on stdin, one a line; each is
// answered by a line of JSON. Files hold doubles, column after column: the inputs, then the output.
//   train FILE ROWS INPUTS | test FILE ROWS INPUTS
//   fit THREADS <extra_trees .../>     cpu_s, wall_s, leaves, and peak_kb of memory beyond what was in use
//   balanced DEPTH INPUTS              makes a tree with all leaves at this depth
//   rmse                               on the test set
//   call                               ns of one call, dependent chain: here, textbook layout; and cold
//   batch                              CPU seconds for the test set
//   kernels                            the instruction set that is used
#include <fmt/format.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest_function.h"
#include "solvers/approximators/tree_kernels.h"
#include "tests/benchmarks/textbook_forest.h"
#include "tests/support/make.h"
#include "tests/support/threads.h"

namespace coppice {
namespace {

double cpu_seconds() {  // in user mode, of all threads
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

long status_kb(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(name, 0) == 0) return std::stol(line.substr(name.size()));
  }
  throw std::runtime_error("no " + name + " in /proc/self/status");
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

struct Samples {
  Matrix x;
  Matrix y;
};

Samples read_samples(std::istream& words) {
  std::string name;
  std::size_t rows = 0;
  std::size_t inputs = 0;
  words >> name >> rows >> inputs;
  Samples samples{Matrix(rows, inputs), Matrix(rows, 1)};
  std::ifstream file(name, std::ios::binary);
  for (Matrix* part : {&samples.x, &samples.y}) {
    const auto bytes = static_cast<std::streamsize>(part->values().size() * sizeof(double));
    if (!file.read(reinterpret_cast<char*>(part->values().data()), bytes))
      throw std::runtime_error("cannot read " + name);
  }
  return samples;
}

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Calls in a chain: each input depends on the last result. Seconds a call.
template <class Predict>
double time_chain(const Matrix& x, Predict predict, double& sum) {
  constexpr std::size_t kCalls = 20000;
  std::vector<std::array<double, 16>> points(std::min(kCalls, x.rows()));
  for (std::size_t i = 0; i < points.size(); ++i) x.row(i, std::span(points[i]).first(x.columns()));
  double last = 0;
  sum = 0;
  const double begin = thread_seconds();
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<double, 16>& point = points[i];
    point[0] += 0 * last;
    last = predict(std::span<const double>(point).first(x.columns()));
    sum += last;
  }
  return (thread_seconds() - begin) / static_cast<double>(points.size());
}

/// Single calls after other data went through the caches, as in a control loop that does other work.
template <class Predict>
double time_cold(const Matrix& x, Predict predict) {
  std::vector<double> other(6'000'000);
  std::vector<double> times;
  std::array<double, 16> point{};
  volatile double sink = 0;
  for (std::size_t i = 0; i < 61; ++i) {
    for (double& value : other) value += 1;
    x.row(i, std::span(point).first(x.columns()));
    const double begin = wall_seconds();
    sink = predict(std::span<const double>(point).first(x.columns()));
    times.push_back(wall_seconds() - begin);
  }
  static_cast<void>(sink);
  return median(times);
}

class Driver {
 public:
  std::string answer(const std::string& line) {
    std::istringstream words(line);
    std::string command;
    words >> command;
    if (command == "train") return train_ = read_samples(words), "{}";
    if (command == "test") return test_ = read_samples(words), "{}";
    if (command == "kernels") return fmt::format("{{\"name\": \"{}\"}}", tree_kernels().name);
    if (command == "fit") return fit(words);
    if (command == "balanced") return balanced(words);
    if (command == "rmse") return rmse();
    if (command == "call") return call();
    if (command == "batch") return batch();
    throw std::runtime_error("unknown command " + command);
  }

 private:
  std::string fit(std::istream& words) {
    std::size_t threads = 1;
    words >> threads;
    std::string xml;
    std::getline(words, xml);
    const auto approximator = make_from_xml<Approximator>(xml);
    Serial serial;
    Threads several(threads);
    Parallel& parallel = threads > 1 ? static_cast<Parallel&>(several) : serial;
    function_ = {};
    std::ofstream("/proc/self/clear_refs") << 5;  // forgets the peak
    const long before = status_kb("VmRSS:");
    const double cpu = cpu_seconds();
    const double wall = wall_seconds();
    function_ = approximator->fit({train_.x, train_.y, {}}, Draws(++seed_, "compare", 0), parallel);
    const double cpu_s = cpu_seconds() - cpu;
    const double wall_s = wall_seconds() - wall;
    return fmt::format(R"({{"cpu_s": {}, "wall_s": {}, "leaves": {}, "peak_kb": {}}})", cpu_s, wall_s,
                       static_cast<double>(forest().leaves()) / static_cast<double>(forest().trees()),
                       status_kb("VmHWM:") - before);
  }

  std::string balanced(std::istream& words) {
    int depth = 0;
    Tree tree;
    words >> depth >> tree.inputs;
    Stream stream = Draws(1, "compare", 0).stream("balanced");
    Box box{{}, {}};
    box.low.assign(tree.inputs, 0.0);
    box.high.assign(tree.inputs, 1.0);
    tree.nodes.resize(1);
    split_evenly(stream, tree, 0, depth, box);
    Forest forest(tree.inputs, {OutputScale{}}, LeafModel::constant);
    forest.add(pack(tree));
    const double leaves = static_cast<double>(forest.leaves());
    function_ = made<Function>(ForestFunction(std::move(forest)), ForestFunction::kName);
    return fmt::format(R"({{"leaves": {}}})", leaves);
  }

  struct Box {
    std::vector<double> low;
    std::vector<double> high;
  };

  static void split_evenly(Stream& stream, Tree& tree, std::int32_t at, int depth, Box& box) {
    if (depth == 0) {
      tree.nodes[at] = {stream.uniform(-1, 1), static_cast<std::int32_t>(tree.inputs), at};
      return;
    }
    const std::size_t axis = stream.below(tree.inputs);
    const double middle = (box.low[axis] + box.high[axis]) / 2;
    const auto child = static_cast<std::int32_t>(tree.nodes.size());
    tree.nodes[at] = {middle, static_cast<std::int32_t>(axis), child};
    tree.nodes.resize(tree.nodes.size() + 2);
    const double high = std::exchange(box.high[axis], middle);
    split_evenly(stream, tree, child, depth - 1, box);
    box.high[axis] = high;
    const double low = std::exchange(box.low[axis], middle);
    split_evenly(stream, tree, child + 1, depth - 1, box);
    box.low[axis] = low;
  }

  std::string rmse() const {
    Matrix y(test_.x.rows(), 1);
    function_->predict_batch(test_.x, y);
    double squares = 0;
    for (std::size_t i = 0; i < y.rows(); ++i) squares += std::pow(y(i, 0) - test_.y(i, 0), 2);
    return fmt::format(R"({{"rmse": {}}})", std::sqrt(squares / static_cast<double>(y.rows())));
  }

  std::string call() const {
    const TextbookForest textbook(forest());
    const auto theirs = [&](std::span<const double> x) { return textbook.predict(x); };
    const auto ours = [&](std::span<const double> x) {
      double y = 0;
      function_->predict(x, {&y, 1});
      return y;
    };
    std::vector<double> our_s;
    std::vector<double> textbook_s;
    double difference = 0;
    for (int round = 0; round < 7; ++round) {
      double a = 0;
      double b = 0;
      our_s.push_back(time_chain(test_.x, ours, a));
      textbook_s.push_back(time_chain(test_.x, theirs, b));
      difference = std::fabs(a - b) / std::max(1.0, std::fabs(b));
    }
    if (forest().leaf() == LeafModel::constant && difference > 1e-9)
      throw std::runtime_error("the two layouts do not predict the same");
    return fmt::format(R"({{"ns": {}, "textbook_ns": {}, "cold_us": {}, "cold_textbook_us": {}}})",
                       1e9 * median(our_s), 1e9 * median(textbook_s), 1e6 * time_cold(test_.x, ours),
                       1e6 * time_cold(test_.x, theirs));
  }

  std::string batch() const {
    Matrix y(test_.x.rows(), 1);
    const double begin = thread_seconds();
    function_->predict_batch(test_.x, y);
    return fmt::format(R"({{"cpu_s": {}}})", thread_seconds() - begin);
  }

  const Forest& forest() const { return static_cast<const ForestFunction&>(*function_.object).forest(); }

  Samples train_;
  Samples test_;
  MadeFunction function_;
  std::uint64_t seed_ = 0;
};

}  // namespace
}  // namespace coppice

int main() {
  coppice::Driver driver;
  for (std::string line; std::getline(std::cin, line);) {
    try {
      std::cout << driver.answer(line) << std::endl;
    } catch (const std::exception& error) {
      std::cerr << "tree_driver: " << error.what() << '\n';
      return 1;
    }
  }
  return 0;
}
