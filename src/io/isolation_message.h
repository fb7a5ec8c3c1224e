// What the importing child writes into its pipe: a mesh with its report, or an Error.
#pragma once

#include <string>

#include "raygrain/error.h"
#include "raygrain/io.h"

namespace raygrain {

std::string encode_mesh(const TriangleMesh& mesh, const LoadReport& report);
std::string encode_error(const Error& error);

/// The mesh of a message; throws the message's Error, or kMalformed (`path`) for a message that is not whole and right.
TriangleMesh decode_message(const std::string& message, const std::string& path, LoadReport& report);

}  // namespace raygrain
