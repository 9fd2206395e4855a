#include "solvers/approximators/gaussian_function.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "engine/vocabulary/elementary.h"
#include "solvers/climb.h"
#include "solvers/lattice.h"

namespace coppice {

double GaussianFunction::value(const GaussianMean& mean, std::span<const double> x,
                               std::span<double> gradient) const {
  const std::size_t d = x.size(), first = d - gradient.size();
  std::array<double, kMaxInputs> inverse{};
  double sum = mean.constant;
  for (std::size_t k = 0; k < d; ++k) {
    inverse[k] = 1 / mean.lengths[k];
    sum += mean.slopes[k] * x[k];
  }
  for (std::size_t k = 0; k < gradient.size(); ++k) gradient[k] = mean.slopes[first + k];
  const double* place = places_.data();
  for (const double weight : mean.weights) {
    double square = 0;
    for (std::size_t k = 0; k < d; ++k) {
      const double t = (x[k] - place[k]) * inverse[k];
      square += t * t;
    }
    const double part = weight * elementary::exp(-0.5 * square);
    sum += part;
    for (std::size_t k = first; k < d; ++k) {
      gradient[k - first] -= part * (x[k] - place[k]) * inverse[k] * inverse[k];
    }
    place += d;
  }
  return sum;
}

void GaussianFunction::predict(std::span<const double> x, std::span<double> y) const {
  for (std::size_t o = 0; o < means_.size(); ++o) y[o] = value(means_[o], x, {});
}

Maximum GaussianFunction::maximize(std::span<const double> prefix, const Space& box,
                                   const Maximization&) const {
  const std::size_t n = box.size();
  const std::size_t probes = 16 + 16 * n;
  std::vector<double> low(n), high(n), x(prefix.begin(), prefix.end());
  for (std::size_t i = 0; i < n; ++i) {
    low[i] = box[i].low;
    high[i] = box[i].high;
  }
  x.resize(prefix.size() + n);
  const Hill hill = [&](std::span<const double> at, std::span<double> gradient) {
    std::copy(at.begin(), at.end(), x.begin() + static_cast<std::ptrdiff_t>(prefix.size()));
    return value(means_.front(), x, gradient);
  };

  struct Probe {
    double value;
    std::vector<double> at;
  };
  std::vector<Probe> found;
  const Lattice lattice(n);
  for (std::size_t p = 0; p < probes; ++p) {
    std::vector<double> at(n);
    for (std::size_t i = 0; i < n; ++i) at[i] = low[i] + lattice(p, i) * (high[i] - low[i]);
    const double here = hill(at, {});
    found.push_back({here, std::move(at)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Probe& a, const Probe& b) { return a.value > b.value; });
  constexpr std::size_t kClimbs = 3;
  Probe best = found.front();
  for (std::size_t s = 0; n > 0 && s < std::min(kClimbs, found.size()); ++s) {
    const double reached = climb(hill, low, high, found[s].at, 40);
    if (reached > best.value) best = {reached, found[s].at};
  }
  return {Vec<kMaxActionSize>(std::span<const double>(best.at)), best.value};
}

void GaussianFunction::save(Archive& archive) const {
  archive.put("places", places_);
  archive.put("outputs", std::vector<std::int64_t>{static_cast<std::int64_t>(means_.size())});
  for (std::size_t o = 0; o < means_.size(); ++o) {
    const Archive::Scope scope(archive, std::to_string(o));
    const GaussianMean& mean = means_[o];
    archive.put("constants", std::vector<double>{mean.constant, mean.deviation, mean.noise});
    archive.put("slopes", mean.slopes);
    archive.put("lengths", mean.lengths);
    archive.put("weights", mean.weights);
  }
}

void GaussianFunction::load(Archive& archive) {
  const auto refuse = [](bool invalid) {
    if (invalid) throw std::runtime_error("not a valid Gaussian process");
  };
  const auto finite = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  std::vector<double> places = archive.get<std::vector<double>>("places");
  const auto& outputs = archive.get<std::vector<std::int64_t>>("outputs");
  refuse(!finite(places) || outputs.size() != 1 || outputs[0] < 1);
  std::vector<GaussianMean> means;
  for (std::int64_t o = 0; o < outputs[0]; ++o) {
    const Archive::Scope scope(archive, std::to_string(o));
    const auto& constants = archive.get<std::vector<double>>("constants");
    refuse(constants.size() != 3 || !finite(constants));
    GaussianMean mean{.constant = constants[0],
                      .slopes = archive.get<std::vector<double>>("slopes"),
                      .lengths = archive.get<std::vector<double>>("lengths"),
                      .weights = archive.get<std::vector<double>>("weights"),
                      .deviation = constants[1],
                      .noise = constants[2]};
    const std::size_t inputs = mean.lengths.size();
    refuse(inputs < 1 || inputs > kMaxInputs || mean.slopes.size() != inputs);
    refuse(places.size() != inputs * mean.weights.size() || mean.deviation < 0 || mean.noise < 0);
    refuse(!means.empty() && means.front().lengths.size() != inputs);
    refuse(!finite(mean.slopes) || !finite(mean.lengths) || !finite(mean.weights));
    for (const double length : mean.lengths) refuse(!(length > 0));
    means.push_back(std::move(mean));
  }
  *this = GaussianFunction(std::move(places), std::move(means));
}

std::vector<std::pair<std::string, double>> GaussianFunction::facts() const {
  std::vector<std::pair<std::string, double>> facts{{"places", static_cast<double>(samples())}};
  for (std::size_t o = 0; o < means_.size(); ++o) {
    const std::string of = means_.size() > 1 ? " of output " + std::to_string(o) : "";
    facts.emplace_back("deviation" + of, means_[o].deviation);
    facts.emplace_back("noise" + of, means_[o].noise);
    for (std::size_t k = 0; k < inputs(); ++k) {
      facts.emplace_back("length " + std::to_string(k) + of, means_[o].lengths[k]);
    }
  }
  return facts;
}

namespace {
const Component<Function, GaussianFunction> kGaussianFunction(
    GaussianFunction::kName, "The mean of a Gaussian process.",
    "Rasmussen and Williams, Gaussian Processes for Machine Learning (2006), 2.2");
}  // namespace

}  // namespace coppice
