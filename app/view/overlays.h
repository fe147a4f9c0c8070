#pragma once
// What is drawn over the picture and is no part of it: picks, what is under the cursor, messages, help,
// times.

#include <string>
#include <vector>

#include "app/view/session.h"
#include "core/view.h"

namespace meniscus {

class Viewer;

/// A place in the window for a pixel of the picture.
struct PicturePlace {
  double x = 0, y = 0;       ///< of the picture's upper left corner
  double height = 1;         ///< of the picture
  double pixelsPerUnit = 1;  ///< pixels of the picture in one of the window's units
};

void drawPicks(const std::vector<Pick>& picks, const Camera& camera, ImageSize size,
               const PicturePlace& place, double contentScale);
/// Lines at the lower edge of the picture.
void drawStatus(const std::string& hover, const std::string& message, bool isError,
                const PicturePlace& place);
void drawHelp(bool& shown);
void drawBudget(const Viewer& viewer, bool& shown);
/// Where there is no file.
void drawInvitation(const PicturePlace& place);

}  // namespace meniscus
