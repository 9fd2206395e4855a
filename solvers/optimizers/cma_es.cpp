#include "solvers/optimizers/cma_es.h"

#include "solvers/optimizers/box.h"
#include "solvers/optimizers/cma_es_search.h"

namespace coppice {

std::unique_ptr<Search> CmaEs::start(const SearchTask& task) const {
  check_task(task, "cma_es");
  return std::make_unique<CmaSearch>(*this, task);
}

Parameters<CmaEs> CmaEs::parameters() {
  return Parameters<CmaEs>()
      .add("sigma", &CmaEs::sigma, "",
           "First deviation: in widths of the box where a side is finite, absolute where it is not.",
           above(0))
      .automatic("population", &CmaEs::population, "",
                 "Candidates in a generation of the first run; auto: 4 + floor(3 ln n) for n parameters.",
                 between(2, 1000000))
      .add("active", &CmaEs::active, "", "Bad candidates make the covariance smaller where they lie.")
      .choice(
          "covariance", &CmaEs::covariance, {"auto", "full", "separable"},
          "Full, or diagonal with costs linear in the number of parameters; auto: full up to 200 of them.")
      .choice("restarts", &CmaEs::restarts, {"ipop", "bipop", "none"},
              "What follows a run that goes on no longer: one with a larger population; in turn with it "
              "short ones of "
              "small populations and deviations; or nothing.")
      .add("max_restarts", &CmaEs::max_restarts, "", "Restarts at most.", at_least(0))
      .add("growth", &CmaEs::growth, "", "Factor of the population at a restart.", between(1, 10))
      .add("elitist", &CmaEs::elitist, "",
           "The best point so far takes the worst candidate's place; not where the function is noisy.")
      .add("tolerance", &CmaEs::tolerance, "", "A run ends when values vary less for a while.", at_least(0))
      .choice("noise", &CmaEs::noise, {"auto", "on", "off"},
              "Whether to test for noise by evaluating candidates again, and to adapt learning rates when it "
              "disturbs "
              "their ranks; auto: unless the function is known to have none. on: even then.")
      .add("final_share", &CmaEs::final_share, "",
           "Part of the budget for the final choice by paired evaluations, where there is noise.",
           between(0, 0.5));
}

namespace {
const Component<Optimizer, CmaEs> kCmaEs(
    "cma_es", "Covariance matrix adaptation evolution strategy, with restarts and an answer to noise.",
    "Hansen, arXiv 1604.00772; Nomura et al., GECCO 2023 (learning rates); Auger and Hansen, CEC 2005 "
    "(IPOP); "
    "Hansen, GECCO 2009 (BIPOP)",
    3);
}  // namespace

}  // namespace coppice
