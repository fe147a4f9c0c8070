#pragma once
// From the states of a MolViewSpec file to pictures.

#include <string>

#include "app/picture.h"
#include "app/scene/mvs_file.h"

namespace meniscus {

/// The pictures of a scene file, one for each state. `options` are those given beside it; they have their way
/// over the scene's own. Throws InputError naming file and place.
Preparation scenePictures(const std::string& name, MvsFile& file, const RenderOptions& options);

/// --strict: throws InputError if something of a scene is not drawn.
void requireAllSupported(const Preparation& scene);

}  // namespace meniscus
