/// Alhazen for programs that embed it: load a scene or build one in code, render it, take the pixels.
///
///     alhazen::SceneModel scene;
///     scene.camera("perspective", {{"fov", 35}}, alhazen::Pose::look_at({0, 2, -6}, {0, 1, 0}));
///     scene.light("point", {{"I", alhazen::rgb(40, 40, 40)}}, alhazen::Pose::translate(2, 5, -3));
///     scene.material("clay", "diffuse", {{"reflectance", alhazen::rgb(.6, .4, .3)}});
///     scene.shape("sphere", {{"radius", 1}}, {.material = "clay"});
///     scene.render({.spp = 64}).write("clay.png");
///
/// Kinds and their settings are those of the scene language: `alhazen help material diffuse` prints them, and
/// docs/reference/ holds them all. Angles are in degrees, y usually points up, and a camera looks along +z
/// with x to its right. Only standard types appear here. Objects of different threads may be used at the same
/// time, one object by one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#define ALHAZEN_API __attribute__((visibility("default")))

namespace alhazen {

/// "0.1.0".
ALHAZEN_API std::string_view library_version();

/// Something to tell about a scene, and where it stands.
struct Notice {
    bool is_error = true; ///< else a warning
    std::string file; ///< or, for a scene built in code, which thing it is: "material \"clay\""; may be empty
    int line = 0;     ///< from 1; 0: the file as a whole
    int column = 0;   ///< from 1; 0: the line as a whole
    std::string text; ///< what was wrong; what was expected
};

/// Thrown by everything here that can fail. what() holds all the notices, one a line.
class ALHAZEN_API InputError : public std::runtime_error {
  public:
    explicit InputError(std::vector<Notice> notices, const std::string& what);
    ~InputError() override;
    InputError(const InputError&) = default;
    InputError& operator=(const InputError&) = default;
    const std::vector<Notice>& notices() const { return notices_; }

  private:
    std::vector<Notice> notices_;
};

/// The types of the scene language. Positions and directions are three numbers (point2 and vector2: two),
/// colours three, blackbody kelvins, a spectrum wavelength and value in turn (nanometres) or a name, texture
/// a name.
enum class SettingType {
    boolean,
    integer,
    number,
    point2,
    vector2,
    point3,
    vector3,
    normal,
    rgb,
    blackbody,
    spectrum,
    text,
    texture
};

/// The value of a setting: a type, and one or more numbers or words. Plain C++ values turn into it by
/// themselves.
struct SettingValue {
    SettingType type = SettingType::number;
    std::vector<float> numbers;     ///< of all types that hold numbers with fractions
    std::vector<int> integers;      ///< of boolean (0 or 1) and integer
    std::vector<std::string> words; ///< of text, texture, and spectrum by name

    SettingValue() = default;
    SettingValue(bool value) : type(SettingType::boolean), integers{value ? 1 : 0} {}
    SettingValue(int value) : type(SettingType::integer), integers{value} {}
    SettingValue(double value) : numbers{static_cast<float>(value)} {}
    SettingValue(const char* value) : type(SettingType::text), words{value} {}
    SettingValue(std::string value) : type(SettingType::text), words{std::move(value)} {}
    SettingValue(SettingType type_, std::vector<float> values) : type(type_), numbers(std::move(values)) {}
    SettingValue(SettingType type_, std::vector<int> values) : type(type_), integers(std::move(values)) {}
    SettingValue(SettingType type_, std::vector<std::string> values)
        : type(type_), words(std::move(values)) {}
};

/// A linear colour of Rec. 709 primaries.
inline SettingValue rgb(double r, double g, double b) {
    return {SettingType::rgb,
            std::vector<float>{static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)}};
}
/// Light of a glowing body of this temperature.
inline SettingValue blackbody(double kelvins) {
    return {SettingType::blackbody, std::vector<float>{static_cast<float>(kelvins)}};
}
/// A measured spectrum by name ("metal-Au-eta") or by file.
inline SettingValue spectrum(std::string name) {
    return {SettingType::spectrum, std::vector<std::string>{std::move(name)}};
}
/// A texture added before with SceneModel::texture.
inline SettingValue texture(std::string name) {
    return {SettingType::texture, std::vector<std::string>{std::move(name)}};
}
inline SettingValue point3(double x, double y, double z) {
    return {SettingType::point3,
            std::vector<float>{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}};
}

struct Setting {
    std::string name;
    SettingValue value;
};
using Settings = std::vector<Setting>;

/// Where a thing stands: a transformation from its own space to the world's. a * b does b first.
struct ALHAZEN_API Pose {
    using Point = std::array<double, 3>;
    /// Row-major 4 x 4; points are columns.
    std::array<double, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

    static Pose translate(double x, double y, double z);
    static Pose scale(double x, double y, double z);
    /// Counter-clockwise seen against the axis, which must not be zero.
    static Pose rotate(double degrees, Point axis);
    /// Of a camera (or spot light) at eye that looks at target. Throws InputError when eye and target are the
    /// same or up is parallel to the view.
    static Pose look_at(Point eye, Point target, Point up = {0, 1, 0});
    friend ALHAZEN_API Pose operator*(const Pose& a, const Pose& b);
};

/// How a shape is placed and what it is made of.
struct ShapeOptions {
    std::string material{}; ///< one of SceneModel::material; "": a grey, matte one
    Pose pose{};
    std::string emitter{};            ///< one of SceneModel::emitter, which makes the shape a light; "": none
    bool reverse_orientation = false; ///< turns inside and outside around
    std::string object{};             ///< makes the shape a part of this object, seen by instances only
};

/// A triangle mesh as flat arrays.
struct MeshInput {
    std::vector<float> positions{}; ///< x y z of each vertex
    std::vector<int> indices{};     ///< three vertex numbers for each triangle, counted from 0
    std::vector<float> normals{};   ///< x y z of each vertex, for shading; or none
    std::vector<float> uv{};        ///< u v of each vertex; or none
};

/// How far a rendering has come.
struct RenderProgress {
    double fraction = 0; ///< of all the work
    int samples = 0;     ///< per pixel, finished
    int samples_total = 0;
    double seconds = 0;
    double seconds_left = 0; ///< an estimate
};

enum class ColorComputation {
    automatic, ///< spectral, except for integrators that are defined in RGB
    spectral,  ///< by sampled wavelengths
    rgb
};

/// What is wanted of a rendering. What is not set is as the scene says.
struct RenderRequest {
    std::optional<int> spp{};    ///< samples per pixel
    std::optional<int> width{};  ///< pixels; together with height
    std::optional<int> height{}; ///< pixels
    std::string integrator{};    ///< replaces the scene's
    std::string camera{};        ///< by name
    std::optional<std::uint64_t> seed{};
    int threads = 0; ///< 0: all
    /// Bytes of texels of images in memory, at least 1; the others lie in a temporary file. Unset: all in
    /// memory.
    std::optional<std::size_t> texture_memory{};
    ColorComputation color = ColorComputation::automatic;
    /// Single parameters: "integrator.maxdepth=3", "material.clay.reflectance=.5 .4 .3".
    std::vector<std::string> overrides{};
    /// Called up to ten times a second and after each pass, by one thread at a time but not always the same
    /// one. Return false to stop: the pass in hand, of about a second, is finished, and the picture has the
    /// samples up to then.
    std::function<bool(const RenderProgress&)> progress{};
};

/// A finished picture. Copies share the pixels.
class ALHAZEN_API Picture {
  public:
    int width() const;
    int height() const;
    /// Linear light, R G B of each pixel, row by row from the top: width() * height() * 3 floats, as long as
    /// this picture or a copy exists.
    std::span<const float> pixels() const;
    /// Writes .exr, .png, .jpg, .hdr, .pfm, .tga or .bmp by the suffix, whole or not at all. Throws
    /// InputError.
    void write(const std::filesystem::path& file) const;

    int samples() const; ///< per pixel
    double seconds() const;
    std::uint64_t rays() const;
    /// Whether the progress callback stopped it before all samples were there.
    bool was_stopped() const;
    /// What the scene's author should know; each has is_error false.
    const std::vector<Notice>& warnings() const;

    struct Content;
    explicit Picture(std::shared_ptr<const Content> content);

  private:
    std::shared_ptr<const Content> content_;
};

/// A scene to be rendered: from a file, from text, built in code, or a file's with more added. Settings are
/// checked when it is rendered, and all that is wrong is told at once. A name that is used again replaces
/// what it stood for.
class ALHAZEN_API SceneModel {
  public:
    SceneModel();
    SceneModel(const SceneModel&);
    SceneModel(SceneModel&&) noexcept;
    SceneModel& operator=(const SceneModel&);
    SceneModel& operator=(SceneModel&&) noexcept;
    ~SceneModel();

    /// Reads a scene file (.pbrt, .pbrt.gz). lenient: what is unknown is replaced, with a warning. Throws
    /// InputError.
    static SceneModel from_file(const std::filesystem::path& file, bool lenient = false);
    /// Reads a scene in the scene language; relative file names start from folder. Throws InputError.
    static SceneModel from_text(std::string_view text, const std::filesystem::path& folder = ".",
                                bool lenient = false);

    SceneModel& camera(std::string kind, Settings settings = {}, Pose pose = {});
    SceneModel& film(std::string kind, Settings settings = {});
    SceneModel& filter(std::string kind, Settings settings = {});
    SceneModel& sampler(std::string kind, Settings settings = {});
    SceneModel& integrator(std::string kind, Settings settings = {});

    SceneModel& color_texture(std::string name, std::string kind, Settings settings = {}, Pose pose = {});
    SceneModel& number_texture(std::string name, std::string kind, Settings settings = {}, Pose pose = {});
    SceneModel& material(std::string name, std::string kind, Settings settings = {});
    SceneModel& light(std::string kind, Settings settings = {}, Pose pose = {});
    /// What makes shapes shine: emitter("lamp", "diffuse", {{"L", rgb(5, 5, 5)}}).
    SceneModel& emitter(std::string name, std::string kind, Settings settings = {});
    /// options.emitter must have been added before, else throws InputError.
    SceneModel& shape(std::string kind, Settings settings = {}, ShapeOptions options = {});
    SceneModel& mesh(MeshInput mesh, ShapeOptions options = {});
    /// The shapes of an object once more, at pose; inside_object: as a part of that object.
    SceneModel& instance(std::string object, Pose pose = {}, std::string inside_object = {});

    /// Renders and returns the picture; throws InputError before rendering when something is wrong in the
    /// scene or the request. An exception of the progress callback comes out as it is. On a temporary scene,
    /// or with std::move(scene).render(), meshes are not copied.
    Picture render(const RenderRequest& request = {}) const&;
    Picture render(const RenderRequest& request = {}) &&;

  private:
    struct Content;
    std::unique_ptr<Content> content_;
};

} // namespace alhazen
