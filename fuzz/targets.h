// What is fuzzed: functions of bytes. Each comes back, whatever the bytes, or throws a Finding.
#pragma once

#include <cstdint>
#include <exception>
#include <span>
#include <stdexcept>
#include <string>

#include "raygrain/error.h"

namespace raygrain::fuzz {

using Bytes = std::span<const uint8_t>;

/// A promise of the library that the bytes broke.
struct Finding : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool good, const std::string& what) {
  if (!good) throw Finding(what);
}

/// An Error must say where and what.
void check_error(const Error& error);

/// False where `action` refuses its input with an Error, as it may; any other exception is a finding.
template <class Action>
bool accepts(const Action& action) {
  try {
    action();
    return true;
  } catch (const Error& error) {
    check_error(error);
    return false;
  } catch (const Finding&) {
    throw;
  } catch (const std::exception& error) {
    throw Finding(std::string("not an Error: ") + error.what());
  }
}

inline std::string text_of(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}

void obj(Bytes bytes);           // a mesh file in this process
void ply(Bytes bytes);           // ...
void stl(Bytes bytes);           // ...
void import(Bytes bytes);        // a mesh file of any format, in a child process
void scene(Bytes bytes);         // a scene.json beside a mesh and rays; its rays are cast
void areas(Bytes bytes);         // a JSON file of areas alone
void study(Bytes bytes);         // a study's JSON
void tree(Bytes bytes);          // a tree file; a sound one is searched
void rays(Bytes bytes);          // rays as CSV
void results(Bytes bytes);       // results as CSV, up to the report
void command_line(Bytes bytes);  // words, one a line; the command runs in a folder of its own
void traversal(Bytes bytes);     // mesh and rays: all instruction sets and structures against the oracle
void structure(Bytes bytes);     // boxes of any kind and options: every builder's tree is sound

struct Target {
  const char* name;
  void (*run)(Bytes);
};
/// All of the above by name.
std::span<const Target> targets();

}  // namespace raygrain::fuzz
