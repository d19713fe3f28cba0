// A loop with a race, which the thread sanitizer must find: else scripts/sanitize would find
// nothing anywhere.

#include <tbb/parallel_for.h>

#include <cstdio>

int main() {
  int sum = 0;
  tbb::parallel_for(0, 1000, [&](int i) { sum += i; });
  std::printf("%d\n", sum);
  return 0;
}
