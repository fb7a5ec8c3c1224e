// Which reader reads which file. OBJ, PLY and STL are read here and not by Assimp, which rounds text coordinates twice,
// regroups faces by material and takes a file that was cut off for a whole one.
#include <cctype>
#include <filesystem>
#include <new>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "io/isolation.h"
#include "io/mesh_polygons.h"
#include "io/text.h"

namespace raygrain {

namespace {

/// The part behind the last dot, in lower case.
std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  for (char& symbol : ending) symbol = static_cast<char>(std::tolower(static_cast<unsigned char>(symbol)));
  return ending;
}

bool is_read_here(const std::string& ending) {
  return ending == "obj" || ending == "ply" || ending == "stl";
}

/// Refuses, before any importer sees it, what no importer can read.
void check_file(const std::string& path, const std::string& ending) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw Error(ErrorCode::kNotFound, path, "there is no such file", "check the name and the folder");
  if (error) throw Error(ErrorCode::kUnreadable, path, "cannot read: " + error.message());
  if (status.type() == std::filesystem::file_type::directory)
    throw Error(ErrorCode::kUnreadable, path, "is a folder, not a mesh file");
  if (status.type() != std::filesystem::file_type::regular)
    throw Error(ErrorCode::kUnreadable, path, "is not a regular file");
  if (!is_read_here(ending) && (ending.empty() || !assimp_knows(ending)))
    throw Error(ErrorCode::kUnsupported, path,
                ending.empty() ? "the name has no ending that tells its format"
                               : "unknown mesh format " + in_quotes("." + ending),
                "known: obj, ply, stl, gltf, glb; through Assimp also " + assimp_endings());
  if (std::filesystem::file_size(path, error) == 0 && !error)
    throw Error(ErrorCode::kMalformed, path, "the file is empty");
}

PolygonMesh read_polygons(const std::string& path, const std::string& ending) {
  if (ending == "obj") return parse_obj(read_whole_file(path), path);
  if (ending == "ply") return parse_ply(read_whole_file(path), path);
  if (ending == "stl") return parse_stl(read_whole_file(path), path);
  return import_with_assimp(path);
}

std::string counted(size_t count, const char* what) {
  return std::to_string(count) + what + (count == 1 ? "" : "s");
}

[[noreturn]] void refuse_no_triangles(const std::string& path, const LoadReport& report) {
  std::string message = "has no triangles";
  if (report.dropped_lines + report.dropped_points > 0)
    message += ", only " + counted(report.dropped_lines, " line") + " and " + counted(report.dropped_points, " point");
  throw Error(ErrorCode::kBadMesh, path, message, "raygrain needs a surface");
}

TriangleMesh import_mesh(const std::string& path, const std::string& ending, LoadReport& report) {
  PolygonMesh polygons = read_polygons(path, ending);
  report = polygons.dropped;
  TriangleMesh mesh = triangulated(std::move(polygons), path);
  if (mesh.triangles.empty()) refuse_no_triangles(path, report);
  validate(mesh, path);
  // OBJ and PLY share vertices as their author meant; the others repeat them per facet or per material.
  return ending == "obj" || ending == "ply" ? mesh : welded(mesh);
}

TriangleMesh import_here(const std::string& path, const std::string& ending, LoadReport& report) {
  try {
    return import_mesh(path, ending, report);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::kLimit, path, "importing needs more memory than there is", "the file may be damaged");
  } catch (const std::exception& error) {
    throw Error(ErrorCode::kMalformed, path, std::string("the importer failed: ") + error.what());
  }
}

}  // namespace

TriangleMesh load_mesh(const std::string& path, const LoadOptions& options, LoadReport* report) {
  const std::string ending = ending_of(path);
  check_file(path, ending);
  LoadReport found;
  TriangleMesh mesh;
  if (options.isolation == Isolation::kChildProcess) {
    mesh = import_in_child(path, options, found, [&](LoadReport& inner) { return import_mesh(path, ending, inner); });
    if (mesh.triangles.empty()) refuse_no_triangles(path, found);
    validate(mesh, path);  // the child is not to be trusted
  } else {
    mesh = import_here(path, ending, found);
  }
  if (report) *report = found;
  return mesh;
}

}  // namespace raygrain
