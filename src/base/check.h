// Programmer errors: RAYGRAIN_CHECK_EQ(a, b) and friends print both values and the place. On in debug builds and
// wherever RAYGRAIN_CHECKS is defined (sanitizer and CI builds). The library never aborts in a release without them:
// they vanish.
#pragma once

#ifdef RAYGRAIN_CHECKS
#include <sstream>

namespace raygrain::detail {
[[noreturn]] void check_failed(const char* file, int line, const char* expression, const char* values);

template <class A, class B>
[[noreturn]] void check_failed_values(const char* file, int line, const char* expression, const A& a, const B& b) {
  std::ostringstream values;
  values << a << " and " << b;
  check_failed(file, line, expression, values.str().c_str());
}
}  // namespace raygrain::detail

#define RAYGRAIN_CHECK_OPERATION(a, b, op)                                                                \
  do {                                                                                                    \
    const auto& check_a_ = (a);                                                                           \
    const auto& check_b_ = (b);                                                                           \
    if (!(check_a_ op check_b_))                                                                          \
      ::raygrain::detail::check_failed_values(__FILE__, __LINE__, #a " " #op " " #b, check_a_, check_b_); \
  } while (false)
#define RAYGRAIN_CHECK(condition)                                                           \
  do {                                                                                      \
    if (!(condition)) ::raygrain::detail::check_failed(__FILE__, __LINE__, #condition, ""); \
  } while (false)
#else
#define RAYGRAIN_CHECK_OPERATION(a, b, op) static_cast<void>(0)
#define RAYGRAIN_CHECK(condition) static_cast<void>(0)
#endif

#define RAYGRAIN_CHECK_EQ(a, b) RAYGRAIN_CHECK_OPERATION(a, b, ==)
#define RAYGRAIN_CHECK_NE(a, b) RAYGRAIN_CHECK_OPERATION(a, b, !=)
#define RAYGRAIN_CHECK_LT(a, b) RAYGRAIN_CHECK_OPERATION(a, b, <)
#define RAYGRAIN_CHECK_LE(a, b) RAYGRAIN_CHECK_OPERATION(a, b, <=)
