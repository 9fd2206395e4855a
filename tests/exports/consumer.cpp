// A program on a robot: reads states (doubles) from standard input and writes the actions of the policy
// POLICY, which HEADER holds.
#include HEADER
#include HEADER  // a second time: nothing happens

#include <cstdio>

int main() {
  double state[POLICY::kStateSize];
  double action[POLICY::kActionSize];
  while (std::fread(state, sizeof state, 1, stdin) == 1) {
    POLICY::act(state, action);
    if (std::fwrite(action, sizeof action, 1, stdout) != 1) return 1;
  }
  return 0;
}
