// Where the scenes of ready-made studies come from.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "raygrain/study.h"

namespace raygrain::study {

/// The scenes of the paper that are there, with their areas; `missing` says which are not. Throws Error (kUsage) for
/// names in `sources.only` that no scene of `extra` or the paper has.
std::vector<StudyScene> paper_scenes(const StudySources& sources, std::vector<std::string>& missing,
                                     const std::vector<StudyScene>& extra = {});

/// "procedural:..." with its own areas, named as its kind and size.
StudyScene procedural_scene(const std::string& text, const std::string& name);

/// The mesh of a source ("procedural:..." or a file), each vertex times `scale`.
TriangleMesh load_scaled(const std::string& path, float scale);

/// Size and checksum of a file, or of a mesh: tells models apart.
std::string content_of_file(const std::string& path);
std::string content_of(const TriangleMesh& mesh);
/// Of all these scenes.
std::string contents_of(const std::vector<StudyScene>& scenes);

/// Throws Error (kUsage) for what in `sources.only` is none of the names.
void check_wanted(const StudySources& sources, const std::vector<std::string_view>& names);

/// Names of the paper's scenes.
std::vector<std::string_view> paper_scene_names();

/// Is it one of the scenes asked for?
bool is_wanted(const StudySources& sources, const std::string& scene);

/// More than 100,000 triangles: only a part of a grid's rows is run for it.
bool is_large(const StudyScene& scene);

}  // namespace raygrain::study
