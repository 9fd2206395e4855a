#include "engine/graph/jobs.h"

#include <set>
#include <unordered_map>

namespace coppice {

std::vector<Job> make_jobs(const std::vector<const Plan*>& plans,
                           const std::vector<std::vector<NodeStatus>>& statuses) {
  std::vector<Job> jobs;
  std::unordered_map<std::string, std::size_t> by_key;
  for (std::size_t p = 0; p < plans.size(); ++p) {
    for (std::size_t n = 0; n < plans[p]->nodes.size(); ++n) {
      const std::string& key = plans[p]->nodes[n].key;
      if (!statuses[p][n].runs || !by_key.emplace(key, jobs.size()).second) continue;
      jobs.emplace_back().key = key;
    }
  }
  std::set<std::pair<std::size_t, std::size_t>> edges;
  for (std::size_t p = 0; p < plans.size(); ++p) {
    for (std::size_t n = 0; n < plans[p]->nodes.size(); ++n) {
      const PlannedNode& node = plans[p]->nodes[n];
      const auto job = by_key.find(node.key);
      if (job == by_key.end() || statuses[p][n].reason == Reason::not_selected) continue;
      std::vector<NodePlace>& places = jobs[job->second].places;
      places.insert(statuses[p][n].runs ? places.begin() : places.end(), {p, n});
      for (const PlannedInput& input : node.inputs) {
        for (const std::size_t i : input.nodes) {
          const auto needed = by_key.find(plans[p]->nodes[i].key);
          if (needed == by_key.end() || !edges.emplace(needed->second, job->second).second) continue;
          jobs[needed->second].dependants.push_back(job->second);
          ++jobs[job->second].waiting_for;
        }
      }
    }
  }
  return jobs;
}

}  // namespace coppice
