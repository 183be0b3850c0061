// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <io/files/bitmap_font.hpp>

namespace penumbra::io {
namespace {

constexpr char first_letter = ' ';
constexpr char last_letter = '~';
constexpr int letters_per_strip = 16;
constexpr int strip_columns = letters_per_strip * BitmapFont::advance + 1;  // with the line's end
constexpr int letter_width = BitmapFont::advance - 1;

// ASCII from space to ~ in six strips of sixteen letters; two rows hang below the base line.
constexpr std::string_view drawing =
    R"(        #    # #   # #    #   ##     ##     #      #   #                                       |
        #    # #   # #   #### ##  # #  #    #     #     #     #     #                         #|
        #    # #  ##### # #      #  # #     #    #       #  # # #   #                        # |
        #          # #   ###    #    #           #       #   ###  #####       #####         #  |
        #         #####   # #  #    # # #        #       #  # # #   #                      #   |
                   # #  ####  #  ## #  #          #     #     #     #    ##          ##   #    |
        #          # #    #      ##  ## #          #   #                 ##          ##        |
                                                                          #                    |
                                                                         #                     |
 ###    #    ###  #####    #  #####   ##  #####  ###   ###                 #         #     ### |
#   #  ##   #   #    #    ##  #      #        # #   # #   #  ##    ##     #           #   #   #|
#  ##   #       #   #    # #  ####  #        #  #   # #   #  ##    ##    #    #####    #      #|
# # #   #      #     #  #  #      # ####    #    ###   ####             #               #    # |
##  #   #     #       # #####     # #   #  #    #   #     #  ##          #    #####    #    #  |
#   #   #    #    #   #    #  #   # #   #  #    #   #    #   ##    ##     #           #        |
 ###   ###  #####  ###     #   ###   ###   #     ###   ##          ##      #         #      #  |
                                                                    #                          |
                                                                   #                           |
 ###   ###  ####   ###  ###   ##### #####  ###  #   #  ###    ### #   # #     #   # #   #  ### |
#   # #   # #   # #   # #  #  #     #     #   # #   #   #      #  #  #  #     ## ## #   # #   #|
# ### #   # #   # #     #   # #     #     #     #   #   #      #  # #   #     # # # ##  # #   #|
# # # ##### ####  #     #   # ####  ####  # ### #####   #      #  ##    #     # # # # # # #   #|
# ### #   # #   # #     #   # #     #     #   # #   #   #      #  # #   #     #   # #  ## #   #|
#     #   # #   # #   # #  #  #     #     #   # #   #   #   #  #  #  #  #     #   # #   # #   #|
 #### #   # ####   ###  ###   ##### #      #### #   #  ###   ##   #   # ##### #   # #   #  ### |
                                                                                               |
                                                                                               |
####   ###  ####   #### ##### #   # #   # #   # #   # #   # #####  ###         ###    #        |
#   # #   # #   # #       #   #   # #   # #   # #   # #   #     #  #    #        #   # #       |
#   # #   # #   # #       #   #   # #   # #   #  # #  #   #    #   #     #       #  #   #      |
####  #   # ####   ###    #   #   # #   # # # #   #    # #    #    #      #      #             |
#     # # # # #       #   #   #   # #   # # # #  # #    #    #     #       #     #             |
#     #  #  #  #      #   #   #   #  # #  # # # #   #   #   #      #        #    #             |
#      ## # #   # ####    #    ###    #    # #  #   #   #   #####  ###         ###        #####|
                                                                                               |
                                                                                               |
 #          #               #         ##        #       #      #  #      ##                    |
  #         #               #        #  #       #                 #       #                    |
   #   ###  # ##   ###   ## #  ###   #     #### # ##   ##     ##  #  #    #   ## #  # ##   ### |
          # ##  # #     #  ## #   # ###   #   # ##  #   #      #  # #     #   # # # ##  # #   #|
       #### #   # #     #   # #####  #    #   # #   #   #      #  ##      #   # # # #   # #   #|
      #   # #   # #   # #   # #      #    #   # #   #   #      #  # #     #   # # # #   # #   #|
       #### ####   ###   ####  ###   #     #### #   #  ###     #  #  #   ###  # # # #   #  ### |
                                              #             #  #                               |
                                           ###               ##                                |
                         #                                           #    #    #               |
                         #                                          #     #     #              |
####   #### # ##   #### ###   #   # #   # #   # #   # #   # #####   #     #     #    #  #      |
#   # #   # ##  # #      #    #   # #   # #   #  # #  #   #    #   #      #      #  # # #      |
#   # #   # #      ###   #    #   # #   # # # #   #   #   #   #     #     #     #   #  #       |
#   # #   # #         #  #  # #  ##  # #  # # #  # #  #   #  #      #     #     #              |
####   #### #     ####    ##   ## #   #    # #  #   #  #### #####    #    #    #               |
#         #                                               #                                    |
#         #                                            ###                                     |
)";

static_assert(drawing.size() == std::size_t{6} * BitmapFont::height * strip_columns);

bool is_ink(char letter, int column, int row) {
  const int index = letter - first_letter;
  const int strip_row = index / letters_per_strip * BitmapFont::height + row;
  const int strip_column = index % letters_per_strip * BitmapFont::advance + column;
  const int place = strip_row * strip_columns + strip_column;
  return drawing[static_cast<std::size_t>(place)] == '#';
}

}  // namespace

void BitmapFont::fill(int u, int v, int size, Rgb8 color, Image<Rgb8>& image) {
  for (int y = std::max(v, 0); y < std::min(v + size, image.height()); ++y)
    for (int x = std::max(u, 0); x < std::min(u + size, image.width()); ++x) image(x, y) = color;
}

void BitmapFont::draw(std::string_view text, int u, int v, int scale, Rgb8 color,
                      Image<Rgb8>& image) {
  for (const char c : text) {
    if (u >= image.width()) return;
    const char letter = c >= first_letter && c <= last_letter ? c : '?';
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < letter_width; ++column)
        if (is_ink(letter, column, row))
          fill(u + column * scale, v + row * scale, scale, color, image);
    u += advance * scale;
  }
}

}  // namespace penumbra::io
