// Faults on purpose, for the sanitizers to find: faulty leak | use_after_free | overflow.
#include <climits>
#include <cstdio>
#include <string>

namespace {

// The compiler must not see through these.
volatile int one = 1;
int* volatile kept = nullptr;

void leak() {
  kept = new int(one);
  kept = nullptr;
}

int use_after_free() {
  kept = new int(one);
  delete kept;
  return *kept;
}

int overflow() {
  return INT_MAX + one;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string fault = count > 1 ? arguments[1] : "";
  int result = 0;
  if (fault == "leak") leak();
  if (fault == "use_after_free") result = use_after_free();
  if (fault == "overflow") result = overflow();
  std::printf("%d: not noticed by now\n", result);
  return 0;
}
