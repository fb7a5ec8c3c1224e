// Files: meshes, scene.json, rays and hits, trees as text, pictures. Formats are in docs/formats.md.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "raygrain/bvh.h"
#include "raygrain/mesh.h"
#include "raygrain/ray.h"
#include "raygrain/scene.h"

namespace raygrain {

enum class Isolation {
  kNone,          // import in this process
  kChildProcess,  // import in a forked child with memory and time limits: a crash there is an Error here
};

struct LoadOptions {
  Isolation isolation = Isolation::kNone;
  uint64_t memory_limit = uint64_t{8} << 30;  // bytes, of the child
  uint32_t time_limit = 300;                  // seconds of CPU, of the child
};

/// What an importer found besides the mesh.
struct LoadReport {
  size_t dropped_lines = 0, dropped_points = 0;
};

/// Reads OBJ, PLY, STL, glTF/GLB and what else Assimp knows. Node transforms are applied, polygons triangulated,
/// triangles keep the file's order. Throws Error: kNotFound, kUnreadable, kMalformed, kUnsupported, kLimit, kBadMesh
/// (no triangles, non-finite vertex with its index, index out of range), each naming the file.
TriangleMesh load_mesh(const std::string& path, const LoadOptions& options = {}, LoadReport* report = nullptr);

/// Writes .obj (text) or .ply (binary) by the path's ending; vertices keep their exact float values.
void save_mesh(const TriangleMesh& mesh, const std::string& path);

/// SCENE of the command line: a mesh file, a scene.json, or "procedural:...".
Scene load_scene(const std::string& scene, const LoadOptions& options = {});

/// Writes scene.json beside a binary PLY of its mesh (NAME.json and NAME.ply). Lists of rays that JSON cannot hold
/// (NaN, infinity) go to NAME-rays-N.csv.
void save_scene(const Scene& scene, const std::string& path);

/// A JSON file with "areas" alone (the --areas option), or a whole scene.json's areas.
std::vector<InfluenceArea> load_areas(const std::string& path);

/// CSV with header ox,oy,oz,dx,dy,dz and optional tmin,tmax (default 0, inf), columns in any order; inf and nan are
/// numbers; blank lines and lines that start with # are skipped. Throws Error: kNotFound, kUnreadable, kMalformed with
/// file:line:column (bytes, from 1).
std::vector<Ray> load_rays(const std::string& path);

/// Numbers are written so that load_rays returns the same bits (NaN stays NaN).
void save_rays(std::span<const Ray> rays, const std::string& path);

/// CSV with header t,u,v,triangle; a miss is inf,0,0,-1.
void save_hits(std::span<const Hit> hits, const std::string& path);

/// The nodes of a tree as JSON: {"format": "raygrain-tree", "version": 1, "info": {...}, "node_fields": [...], "nodes":
/// [[lo_x, lo_y, lo_z, hi_x, hi_y, hi_z, first, count], ...], "prims": [...]}, meaning what Bvh says; a coordinate that
/// is not finite is null. `info_json` is a rendered JSON object for "info"; empty: {}.
void save_tree_json(const Bvh& bvh, const std::string& info_json, const std::string& path);

/// A built tree as a file of its own: little endian, with a version and a checksum; docs/formats.md has the bytes.
void save_tree(const Bvh& bvh, const std::string& path);

/// Reads what save_tree wrote. Throws Error: kNotFound, kUnreadable, kMalformed (foreign, damaged or cut files, and
/// links that make no sound tree), kUnsupported (another version). Whether the boxes hold their primitives only
/// find_defect can say, who is given these: trees from others should be passed to it, as the Accelerator does.
Bvh load_tree(const std::string& path);

/// Writes a whole file or none: into a temporary file beside `path`, flushed, then renamed over it. A failure throws
/// Error (kUnwritable) and leaves no trace.
void write_file_atomically(const std::string& path, const std::function<void(std::ostream&)>& write);

/// Removes the temporary files of writes in progress; safe to call from a signal handler's clean-up
/// (async-signal-safe).
void remove_unfinished_files() noexcept;

/// Creates a folder and its parents. Throws Error (kUnwritable) if that cannot be, or if nothing can be written in it.
void make_output_folder(const std::string& path);

/// 8-bit RGB pixels, row by row from the top left.
struct Image {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

/// Throws Error: kUsage (no pixels, or not width * height of them), kLimit (over 1 GiB), kUnwritable.
void save_png(const Image& image, const std::string& path);

}  // namespace raygrain
