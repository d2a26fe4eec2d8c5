/// Integrates a function over the unit square, whatever the scene is, with the scene's sampler: each pixel is
/// an estimate of its own, and how far they are off on average tells how good the sampler is. The picture:
/// noise, white on average; of the better sampler, a sheet of paper.
#include "base/threads.h"
#include "image/codec.h"
#include "integrators/integrator.h"
#include "integrators/quadrature.h"
#include "integrators/square_function.h"

namespace alhazen {

namespace {

constexpr double exact = 1; ///< the integral of all the functions

struct FunctionOptions {
    SquareFunction function = SquareFunction::step;
    bool skipbad = true;
    std::string filename, imagefilename;
};

class FunctionWork final : public PictureWork {
  public:
    FunctionWork(const PictureOrder& picture, const FunctionOptions& options)
        : picture_(picture), options_(options), width_(picture.film.pixels().width()),
          sums_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(picture.film.pixels().height())),
          shown_(sums_.size()) {}

    int passes() const override { return picture_.samples; }

    /// One sample more for each pixel; all anew where a sampler places so many in another way than fewer.
    PictureCounts run(int pass, const std::function<void(double)>& progress) override {
        const int samples = pass + 1;
        const bool is_told = !options_.skipbad || picture_.sampler.is_even(samples);
        const std::unique_ptr<Sampler> own = picture_.sampler.for_count(samples);
        if (own && !is_told) return {};
        ++shown_passes_;
        parallel_for(sums_.size(), 256, [&](std::size_t i) {
            if (own) sums_[i] = 0;
            const Sampler& sampler = own ? *own : picture_.sampler;
            for (int s = own ? 0 : pass; s < samples; ++s) sums_[i] += sample(sampler, pixel(i), s);
            show(i, sums_[i] / samples);
        });
        if (is_told) errors_.push_back({samples, mean_squared_error(samples)});
        progress(1);
        return {};
    }

    std::optional<Quadrature> quadrature() const override {
        Quadrature q{errors_, {}, options_.filename, options_.imagefilename};
        if (!q.integrand_file.empty()) q.integrand = integrand();
        return q;
    }

  private:
    Vec2i pixel(std::size_t i) const {
        const int at = static_cast<int>(i);
        return picture_.film.pixels().lo + Vec2i(at % width_, at / width_);
    }
    double sample(const Sampler& sampler, Vec2i pixel, int number) const {
        const Vec2 u = SampleStream(sampler, pixel, static_cast<std::uint32_t>(number)).pixel2();
        return value_at(options_.function, static_cast<double>(u.x), static_cast<double>(u.y));
    }
    // The film shows the mean of what it was given; what moves that to the estimate is the sample itself
    // where the samples before have stayed.
    void show(std::size_t i, double estimate) {
        const double moves = shown_passes_ * estimate - (shown_passes_ - 1) * shown_[i];
        picture_.film.add(pixel(i), Spectrum(static_cast<float>(moves)), Wavelengths::rgb(), 1);
        shown_[i] = estimate;
    }
    double mean_squared_error(int samples) const {
        double sum = 0;
        for (const double s : sums_) sum += (s / samples - exact) * (s / samples - exact);
        return sum / static_cast<double>(sums_.size());
    }
    Image integrand() const {
        constexpr int places = 16; // on each side of a pixel
        const Rect2i pixels = picture_.film.pixels();
        Image image = Image::grey_image(pixels.width(), pixels.height());
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                double sum = 0;
                for (int i = 0; i < places * places; ++i)
                    sum += value_at(options_.function, (x + (i % places + 0.5) / places) / image.width(),
                                    (y + (i / places + 0.5) / places) / image.height());
                image.at(x, y) = static_cast<float>(sum / (places * places));
            }
        return image;
    }

    PictureOrder picture_;
    FunctionOptions options_;
    int width_;
    std::vector<double> sums_;  ///< of all samples of each pixel
    std::vector<double> shown_; ///< what the film shows there
    int shown_passes_ = 0;
    std::vector<QuadratureError> errors_;
};

struct Function final : Integrator, FunctionOptions {
    static void describe(Fields<Function>& f) {
        f.about(
            "Tries the sampler: integrates a function of integral 1 over the unit square, with the pairs "
            "of numbers that place samples in their pixel. Nothing of the scene is seen. Each pixel is an "
            "estimate by as many samples; their mean squared error for 1, 2, 4 ... samples is printed, "
            "and written by --stats.");
        f.field("function", &Function::function, "what is integrated");
        f.field("skipbad", &Function::skipbad,
                "tell the error for those numbers of samples only that the sampler spreads best: powers of "
                "two, of six for halton, squares for stratified; else for all");
        f.field("filename", &Function::filename,
                "text file for the errors, too: a line for each number of samples");
        f.field("imagefilename", &Function::imagefilename, "picture of the function");
    }
    void finish(const Node& node, BuildContext& context) {
        if (imagefilename.empty() || has_image_suffix(imagefilename)) return;
        context.messages.add_error(
            node.find("imagefilename")->place,
            "parameter \"imagefilename\" is \"" + imagefilename +
                "\", which is no kind of picture that can be written; .exr and .png are");
    }

    bool works_in_rgb() const override { return true; }
    bool follows_camera_rays() const override { return false; }
    std::unique_ptr<PictureWork> whole_picture(const PictureOrder& picture) const override {
        return std::make_unique<FunctionWork>(picture, *this);
    }
    Task<Spectrum> radiance(Ray, PathContext&) const override { co_return Spectrum(0); }
};

} // namespace

Kind<Integrator> function_integrator() {
    return make_kind<Integrator, Function>("function");
}

} // namespace alhazen
