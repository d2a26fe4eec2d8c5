/// A picture in red, green and blue.
#include "film/picture_film.h"

namespace alhazen {
namespace {

struct RgbFilm final : PictureFilm {
    // Pixels ahead are fetched: tiles touch few in a row.
    void add_even(std::span<const EvenSamples> all) override {
        constexpr std::size_t ahead = 12;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i + ahead < all.size()) fetch(all[i + ahead].pixel);
            for (int k = 0; k < all[i].count; ++k)
                PictureFilm::add(all[i].pixel, all[i].L, Wavelengths::rgb(), 1);
        }
    }

    static void describe(Fields<RgbFilm>& f) {
        f.about("A digital camera's picture: red, green and blue for each pixel.");
        describe_picture(f);
        f.example("square", {make_integer("xresolution", 64), make_integer("yresolution", 64)});
        f.example("middle",
                  {make_array("cropwindow", ValueType::real, std::vector<float>{.25f, .75f, .25f, .75f})});
    }
};

} // namespace

Kind<Film> rgb_film() {
    return make_kind<Film, RgbFilm>("rgb");
}

} // namespace alhazen
