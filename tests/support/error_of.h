// The Error that an action throws.
#pragma once

#include <gtest/gtest.h>

#include "raygrain/error.h"

namespace raygrain::test {

/// A failure of the test where it throws none.
template <class Action>
Error error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no Error was thrown";
  return Error(ErrorCode::kUsage, "", "none");
}

}  // namespace raygrain::test
