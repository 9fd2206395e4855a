#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "solvers/optimizers/box.h"
#include "solvers/optimizers/generations.h"
#include "solvers/optimizers/nlopt_run.h"
#include "solvers/optimizers/paired_choice.h"

namespace coppice {
namespace {

constexpr std::size_t kFinalists = 8;

/// A run of NLopt, asked and told. It is saved as the values told, and goes on by replay. NLopt's methods
/// take the function for deterministic: under noise all their evaluations meet one scenario, and the best
/// points come into a final choice on others.
class NloptSearch : public Generations {
 public:
  NloptSearch(NloptSettings settings, const SearchTask& task, double final_share)
      : Generations(task), settings_(std::move(settings)) {
    settings_.box = task.box;
    settings_.first = first_point(task);
    settings_.seed = task.draws.fork("nlopt").key();
    final_ = task.noisy ? static_cast<std::int64_t>(final_share * static_cast<double>(task.budget)) : 0;
    if (final_ < 2) final_ = 0;
    settings_.evaluations = task.budget - final_;
  }

  std::vector<double> best() const override {
    if (choice_.finalists() > 0) return choice_.best_point();
    if (best_.rows() == 0) return settings_.first;
    std::vector<double> x(dimension());
    best_.row(0, x);
    return x;
  }
  double best_value() const override {
    const double chosen = choice_.best_value();
    if (!std::isnan(chosen)) return chosen;
    return best_values_.empty() ? std::numeric_limits<double>::quiet_NaN() : best_values_[0];
  }

 protected:
  Candidates next_generation(std::int64_t) override {
    if (choice_.finalists() > 0) return choice_.next_round();
    Candidates generation{Matrix(0, dimension()), {}};
    if (!run_) start_run();
    const std::vector<double>* x = run_->candidate();
    if (x == nullptr) {
      stop(run_->reason());
      return generation;
    }
    generation = {Matrix(1, dimension()), {0}};
    generation.points.set_row(0, *x);
    return generation;
  }

  void learn(const Candidates& generation, std::span<const double> values) override {
    if (choice_.finalists() > 0) {
      choice_.learn(values);
      if (choice_.done()) stop(reason_);
      return;
    }
    remember(generation.points, values[0]);
    told_.push_back(values[0]);
    run_->answer(values[0]);
    if (run_->candidate() != nullptr) return;
    reason_ = run_->reason();
    if (final_ > 0) {
      choice_ = PairedChoice(best_, final_, 1);
    } else {
      stop(reason_);
    }
  }

  void save_method(Archive& archive) const override {
    archive.put("library", nlopt_version_text());
    archive.put("told_values", told_);
    archive.put("reason", reason_);
    save_matrix(archive, "best", best_);
    archive.put("best_values", best_values_);
    choice_.save(archive);
  }
  void load_method(Archive& archive) override {
    const auto& library = archive.get<std::string>("library");
    if (library != nlopt_version_text()) {
      throw std::runtime_error(fmt::format(
          "search: begun with NLopt {}, which this program's, {}, may not continue in the same way", library,
          nlopt_version_text()));
    }
    told_ = archive.get<std::vector<double>>("told_values");
    reason_ = archive.get<std::string>("reason");
    best_ = load_matrix(archive, "best", dimension());
    best_values_ = load_numbers(archive, "best_values", best_.rows());
    choice_.load(archive, dimension());
    run_.reset();
    if (choice_.finalists() == 0 && stop_reason().empty()) start_run();
  }

 private:
  void start_run() { run_ = std::make_unique<NloptRun>(settings_, told_); }

  /// Keeps the best points, best first: one without noise, some for the final choice under noise.
  void remember(const Matrix& points, double value) {
    const auto place = static_cast<std::size_t>(
        std::find_if(best_values_.begin(), best_values_.end(), [&](double b) { return value > b; }) -
        best_values_.begin());
    const std::size_t most = final_ > 0 ? kFinalists : 1;
    if (place >= most) return;
    best_values_.insert(best_values_.begin() + static_cast<std::ptrdiff_t>(place), value);
    best_values_.resize(std::min(best_values_.size(), most));
    Matrix kept(best_values_.size(), dimension());
    std::vector<double> x(dimension());
    for (std::size_t i = 0; i < kept.rows(); ++i) {
      if (i == place) {
        points.row(0, x);
      } else {
        best_.row(i < place ? i : i - 1, x);
      }
      kept.set_row(i, x);
    }
    best_ = std::move(kept);
  }

  NloptSettings settings_;
  std::int64_t final_ = 0;    ///< evaluations for the final choice
  std::vector<double> told_;  ///< to the library
  std::unique_ptr<NloptRun> run_;
  std::string reason_;  ///< why the run ended
  Matrix best_;
  std::vector<double> best_values_;
  PairedChoice choice_;
};

/// What a method has besides tolerances.
struct Traits {
  const char* name;
  nlopt_algorithm algorithm;
  bool boxed;       ///< needs a finite box
  bool stepping;    ///< begins with a step from the guess
  bool population;  ///< has one
};
constexpr Traits kBobyqa{"bobyqa", NLOPT_LN_BOBYQA, false, true, false};
constexpr Traits kCobyla{"cobyla", NLOPT_LN_COBYLA, false, true, false};
constexpr Traits kSbplx{"sbplx", NLOPT_LN_SBPLX, false, true, false};
constexpr Traits kNelderMead{"nelder_mead", NLOPT_LN_NELDERMEAD, false, true, false};
constexpr Traits kCrs2{"crs2", NLOPT_GN_CRS2_LM, true, false, true};
constexpr Traits kIsres{"isres", NLOPT_GN_ISRES, true, false, true};
constexpr Traits kEsch{"esch", NLOPT_GN_ESCH, true, false, true};
constexpr Traits kDirectL{"direct_l", NLOPT_GN_DIRECT_L, true, false, false};
constexpr Traits kMlsl{"mlsl", NLOPT_G_MLSL_LDS, true, true, true};

std::ptrdiff_t free_axes(const SearchTask& task) {
  return std::count_if(task.box.begin(), task.box.end(),
                       [](const Axis& axis) { return axis.low < axis.high; });
}

template <const Traits& kTraits>
class Nlopt : public Optimizer {
 public:
  enum class Local { bobyqa, cobyla, sbplx, nelder_mead };
  double point_tolerance = 1e-8;
  double value_tolerance = 0;
  double final_share = 0.1;
  std::optional<double> initial_step;
  std::optional<int> population;
  Local local = Local::bobyqa;

  std::unique_ptr<Search> start(const SearchTask& task) const override {
    kTraits.boxed ? check_boxed_task(task, kTraits.name) : check_task(task, kTraits.name);
    NloptSettings settings;
    settings.algorithm = kTraits.algorithm;
    settings.point_tolerance = point_tolerance;
    settings.value_tolerance = value_tolerance;
    settings.initial_step = initial_step;
    settings.population = population;
    if (kTraits.algorithm == NLOPT_G_MLSL_LDS) {
      constexpr nlopt_algorithm kLocal[] = {NLOPT_LN_BOBYQA, NLOPT_LN_COBYLA, NLOPT_LN_SBPLX,
                                            NLOPT_LN_NELDERMEAD};
      const bool quadratic = local == Local::bobyqa && free_axes(task) > 1;  // its models need two axes
      settings.local =
          quadratic || local != Local::bobyqa ? kLocal[static_cast<std::size_t>(local)] : NLOPT_LN_COBYLA;
    }
    if (settings.algorithm == NLOPT_LN_BOBYQA && free_axes(task) == 1) {
      throw std::invalid_argument(
          "<bobyqa> needs two axes at least; for one use cobyla, sbplx or nelder_mead");
    }
    return std::make_unique<NloptSearch>(std::move(settings), task, final_share);
  }

  static Parameters<Nlopt> parameters() {
    Parameters<Nlopt> p;
    p.add("point_tolerance", &Nlopt::point_tolerance, "",
          "Ends when steps are below this part of the point's coordinates (NLopt's xtol_rel); 0: never.",
          at_least(0));
    p.add("value_tolerance", &Nlopt::value_tolerance, "",
          "Ends when values change by less than this part of them (NLopt's ftol_rel); 0: never.",
          at_least(0));
    p.add("final_share", &Nlopt::final_share, "",
          "Part of a noisy search's budget for a final choice among the best points, by paired evaluations.",
          between(0, 0.9));
    if constexpr (kTraits.stepping) {
      p.automatic(
          "initial_step", &Nlopt::initial_step, "",
          "First step, as part of a side of the box (absolute where a side is infinite); auto: NLopt's "
          "choice, a quarter of a side or less.",
          above(0));
    }
    if constexpr (kTraits.population) {
      p.automatic("population", &Nlopt::population, "",
                  "Points kept, or drawn at once; auto: NLopt's choice.", between(1, 1000000));
    }
    if constexpr (kTraits.algorithm == NLOPT_G_MLSL_LDS) {
      p.choice("local", &Nlopt::local, {"bobyqa", "cobyla", "sbplx", "nelder_mead"},
               "The method of the local searches (cobyla instead of bobyqa where there is one axis only).");
    }
    return p;
  }
};

const Component<Optimizer, Nlopt<kBobyqa>> kBobyqaComponent(
    "bobyqa", "Local search by quadratic models within a trust region (NLopt); for smooth functions.",
    "M. J. D. Powell, report DAMTP 2009/NA06 (2009)");
const Component<Optimizer, Nlopt<kCobyla>> kCobylaComponent(
    "cobyla", "Local search by linear models within a trust region (NLopt).",
    "M. J. D. Powell, in Advances in Optimization and Numerical Analysis (1994)");
const Component<Optimizer, Nlopt<kSbplx>> kSbplxComponent(
    "sbplx", "Nelder-Mead on a sequence of subspaces (NLopt's Subplex).",
    "T. H. Rowan, Ph.D. thesis, University of Texas at Austin (1990)");
const Component<Optimizer, Nlopt<kNelderMead>> kNelderMeadComponent(
    "nelder_mead", "The simplex method of Nelder and Mead, with bounds (NLopt).",
    "J. A. Nelder and R. Mead, The Computer Journal 7 (1965)");
const Component<Optimizer, Nlopt<kCrs2>> kCrs2Component(
    "crs2", "Global search: controlled random search with local mutation (NLopt).",
    "P. Kaelo and M. M. Ali, J. Optim. Theory Appl. 130 (2006)");
const Component<Optimizer, Nlopt<kIsres>> kIsresComponent(
    "isres", "Global search: improved stochastic ranking evolution strategy (NLopt).",
    "T. P. Runarsson and X. Yao, IEEE Trans. Syst. Man Cybern. C 35 (2005)");
const Component<Optimizer, Nlopt<kEsch>> kEschComponent(
    "esch", "Global search: an evolutionary algorithm (NLopt).",
    "C. H. da Silva Santos, Ph.D. thesis, University of Campinas (2010)");
const Component<Optimizer, Nlopt<kDirectL>> kDirectLComponent(
    "direct_l", "Global search by dividing the box, biased towards local search (NLopt); without randomness.",
    "J. M. Gablonsky and C. T. Kelley, J. Global Optim. 21 (2001)");
const Component<Optimizer, Nlopt<kMlsl>> kMlslComponent(
    "mlsl", "Global search: local searches from points of a low-discrepancy sequence, one a basin (NLopt).",
    "S. Kucherenko and Y. Sytsko, Comput. Optim. Appl. 30 (2005)");

}  // namespace
}  // namespace coppice
