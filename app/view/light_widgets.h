#pragma once
// Widgets for the options about light, also about what is traced by rays. Within a window of ImGui.

#include "app/render_options.h"
#include "app/view/session.h"

namespace meniscus {

/// `o`: what is in force now.
void lightWidgets(Document& document, const RenderOptions& o);

}  // namespace meniscus
