// Importing in a child process with limits: what crashes, hangs or devours memory there is an Error here.
#pragma once

#include <functional>
#include <string>

#include "raygrain/io.h"

namespace raygrain {

using MeshImporter = std::function<TriangleMesh(LoadReport&)>;

/// Calls `importer` in a forked child and brings its mesh, report or Error over. `path` is what errors name. The child
/// is gone when this returns or throws. Throws Error: what the importer threw; kMalformed when it crashed; kLimit when
/// it went beyond the memory or time of `options`; kCancelled when it was interrupted.
///
/// The child must not use threads of this process; locks that other threads held during the fork stay held in it. That
/// costs no more than a wait here: after four times the time limit and a minute it is ended.
TriangleMesh import_in_child(const std::string& path, const LoadOptions& options, LoadReport& report,
                             const MeshImporter& importer);

}  // namespace raygrain
