/// Parameters read into members: what fits, and the exact words for what does not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "describe/kind.h"

namespace alhazen {

enum class Finish { matte, satin, gloss };
template <>
struct EnumNames<Finish> {
    static constexpr std::array names{"matte", "satin", "gloss"};
};

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Thing {
    static constexpr std::string_view family_name = "thing";
    virtual ~Thing() = default;
};

struct Widget final : Thing {
    float radius = 1.5f;
    int count = 3;
    bool hollow = false;
    std::string label = "none";
    Finish finish_kind = Finish::satin;
    Vec3 center{1, 2, 3};
    Vec2 size{4, 5};
    std::vector<float> weights;
    std::optional<float> height;
    std::string file;
    bool was_finished = false;

    static void describe(Fields<Widget>& f) {
        f.about("A widget.");
        f.field("radius", &Widget::radius, "how far it reaches").above(0).unit("m");
        f.field("count", &Widget::count, "how many").in(1, 8);
        f.field("hollow", &Widget::hollow, "whether there is nothing inside");
        f.field("label", &Widget::label, "what is written on it");
        f.field("finish", &Widget::finish_kind, "how it shines");
        f.field("center", &Widget::center, "where it is");
        f.field("size", &Widget::size, "width and height");
        f.field("weights", &Widget::weights, "one a part").at_least(0);
        f.field("height", &Widget::height, "its height").otherwise("the radius");
        f.field("file", &Widget::file, "where it is described").required();
        f.example("small", {make_float("radius", 0.1f), make_string("file", "x")});
    }
    void finish(const Node&, BuildContext&) { was_finished = true; }
};

const KindList<Thing>& things() {
    static const KindList<Thing> kinds{make_kind<Thing, Widget>("widget")};
    return kinds;
}

class FieldsTest : public testing::Test {
  protected:
    // Builds a widget with these parameters, and "file" unless told otherwise.
    const Widget* build(std::vector<Parameter> parameters, bool with_file = true) {
        Node node;
        node.type = "widget";
        node.place = Place::of_file("s.pbrt");
        node.place.line = 4;
        node.place.column = 1;
        if (with_file) parameters.push_back(make_string("file", "f"));
        for (Parameter& p : parameters) {
            p.place = node.place;
            p.place.column = 9;
        }
        node.parameters = std::move(parameters);
        BuildContext context{messages};
        thing = things().make(node, context, "");
        return static_cast<const Widget*>(thing.get());
    }
    // The only message.
    std::string message() const {
        auto list = messages.list();
        return list.size() == 1 ? list[0].full_text() : std::to_string(list.size()) + " messages";
    }

    Messages messages;
    std::unique_ptr<Thing> thing;
};

TEST_F(FieldsTest, DefaultsAreTheInitialisers) {
    const Widget* w = build({});
    ASSERT_NE(w, nullptr);
    EXPECT_EQ(w->radius, 1.5f);
    EXPECT_EQ(w->finish_kind, Finish::satin);
    EXPECT_FALSE(w->height.has_value());
    EXPECT_TRUE(w->was_finished);
}

TEST_F(FieldsTest, ValuesOfEveryType) {
    const Widget* w =
        build({make_float("radius", 0.5f), make_integer("count", 8), make_bool("hollow", true),
               make_string("label", "a"), make_string("finish", "gloss"), make_point3("center", {7, 8, 9}),
               make_array<Vec2>("size", ValueType::vector2, {{1, 2}}),
               make_array<float>("weights", ValueType::real, {1, 2, 3}), make_float("height", 2)});
    ASSERT_NE(w, nullptr) << message();
    EXPECT_EQ(w->radius, 0.5f);
    EXPECT_EQ(w->count, 8);
    EXPECT_TRUE(w->hollow);
    EXPECT_EQ(w->label, "a");
    EXPECT_EQ(w->finish_kind, Finish::gloss);
    EXPECT_EQ(w->center, Vec3(7, 8, 9));
    EXPECT_EQ(w->size, Vec2(1, 2));
    EXPECT_THAT(w->weights, ElementsAre(1, 2, 3));
    EXPECT_EQ(*w->height, 2);
}

TEST_F(FieldsTest, IntegersAreFloatsToo) {
    ASSERT_NE(build({make_integer("radius", 2)}), nullptr);
    EXPECT_EQ(static_cast<Widget*>(thing.get())->radius, 2);
}

TEST_F(FieldsTest, UnknownParameter) {
    EXPECT_EQ(build({make_float("radious", 1)}), nullptr);
    EXPECT_EQ(
        message(),
        "s.pbrt:4:9: error: unknown parameter \"radious\" of thing \"widget\" (did you mean \"radius\"?); "
        "--lenient would ignore it");
}

TEST_F(FieldsTest, UnknownParameterIsAWarningWhenLenient) {
    messages.lenient = true;
    EXPECT_NE(build({make_float("radious", 1)}), nullptr);
    EXPECT_THAT(message(), HasSubstr("warning: unknown parameter \"radious\""));
}

TEST_F(FieldsTest, NothingNearIsAnsweredWithTheList) {
    build({make_float("zzzzzz", 1)});
    EXPECT_THAT(message(), HasSubstr("; known: "));
    EXPECT_THAT(message(), HasSubstr("hollow"));
}

TEST_F(FieldsTest, WrongType) {
    EXPECT_EQ(build({make_string("radius", "big")}), nullptr);
    EXPECT_EQ(message(), "s.pbrt:4:9: error: parameter \"radius\" is declared as string, but must be float");
}

TEST_F(FieldsTest, WrongTypeOfAnEnum) {
    build({make_float("finish", 1)});
    EXPECT_THAT(message(), HasSubstr("parameter \"finish\" is declared as float, but must be string"));
}

TEST_F(FieldsTest, UnknownChoice) {
    build({make_string("finish", "glos")});
    EXPECT_EQ(
        message(),
        "s.pbrt:4:9: error: parameter \"finish\" is \"glos\", which is not known (did you mean \"gloss\"?)");
}

TEST_F(FieldsTest, WrongCount) {
    build({make_array<float>("radius", ValueType::real, {1, 2})});
    EXPECT_EQ(message(), "s.pbrt:4:9: error: parameter \"radius\" has 2 values, but must have one value");
}

TEST_F(FieldsTest, NoValues) {
    build({make_array<float>("radius", ValueType::real, {})});
    EXPECT_EQ(message(), "s.pbrt:4:9: error: parameter \"radius\" has 0 values, but must have one value");
}

TEST_F(FieldsTest, OutOfRange) {
    build({make_integer("count", 9)});
    EXPECT_EQ(message(), "s.pbrt:4:9: error: parameter \"count\" is 9; it must be 1 to 8");
}

TEST_F(FieldsTest, TheBoundItselfMayBeExcluded) {
    build({make_float("radius", 0)});
    EXPECT_EQ(message(), "s.pbrt:4:9: error: parameter \"radius\" is 0; it must be greater than 0");
}

TEST_F(FieldsTest, ArraysNameTheCulprit) {
    build({make_array<float>("weights", ValueType::real, {1, -2, 3})});
    EXPECT_EQ(message(),
              "s.pbrt:4:9: error: parameter \"weights\" is -2 (its 2nd value); it must be at least 0");
}

TEST_F(FieldsTest, NumbersMustBeFinite) {
    build({make_point3("center", {0, infinity, 0})});
    EXPECT_EQ(message(), "s.pbrt:4:9: error: parameter \"center\" is inf; it must be a finite number");
}

TEST_F(FieldsTest, RequiredParameter) {
    EXPECT_EQ(build({}, false), nullptr);
    EXPECT_EQ(message(),
              "s.pbrt:4:1: error: thing \"widget\" needs the parameter \"string file\": where it is "
              "described");
}

TEST_F(FieldsTest, AllErrorsAreReported) {
    build({make_float("radius", -1), make_integer("count", 0), make_bool("label", true)}, false);
    EXPECT_EQ(messages.error_count(), 4u);
}

TEST_F(FieldsTest, TheManualsPage) {
    KindDoc doc = things().find("widget")->doc();
    EXPECT_EQ(doc.about, "A widget.");
    ASSERT_EQ(doc.fields.size(), 10u);
    EXPECT_EQ(doc.fields[0].type, "float");
    EXPECT_EQ(doc.fields[0].default_text, "1.5");
    EXPECT_EQ(doc.fields[0].unit, "m");
    EXPECT_EQ(doc.fields[0].range_text(), "greater than 0");
    EXPECT_EQ(doc.fields[1].range_text(), "1 to 8");
    EXPECT_EQ(doc.fields[4].type, "\"matte\" | \"satin\" | \"gloss\"");
    EXPECT_EQ(doc.fields[4].default_text, "\"satin\"");
    EXPECT_EQ(doc.fields[5].default_text, "[1 2 3]");
    EXPECT_EQ(doc.fields[8].default_text, "the radius");
    EXPECT_TRUE(doc.fields[9].is_required);
    EXPECT_EQ(doc.fields[9].default_text, "");
    EXPECT_EQ(doc.examples.at(0).name, "small");
}

TEST_F(FieldsTest, UnknownKind) {
    Node node;
    node.type = "wigdet";
    BuildContext context{messages};
    EXPECT_EQ(things().make(node, context, "widget"), nullptr);
    EXPECT_THAT(message(), HasSubstr("unknown thing \"wigdet\" (did you mean \"widget\"?)"));
}

TEST(NodeTest, SetReplaces) {
    Node node;
    node.set(make_float("a", 1));
    node.set(make_float("a", 2));
    node.set(make_float("b", 3));
    EXPECT_EQ(node.parameters.size(), 2u);
    EXPECT_EQ(std::get<std::vector<float>>(node.find("a")->values)[0], 2);
    EXPECT_EQ(node.find("c"), nullptr);
}

TEST_F(FieldsTest, ASubstituteKeepsTheParametersItReads) {
    messages.lenient = true;
    BuildContext context{messages};
    Node node;
    node.type = "gizmo";
    node.name = "mine";
    node.parameters = {make_float("radius", 0.5f),
                       make_integer("widget.count", 7),
                       make_string("hollow", "very"),
                       make_float("height", 2),
                       make_float("spin", 1),
                       make_float("widget.radius", 9),
                       make_array<float>("weights", ValueType::real, {1, -2}),
                       make_string("file", "f")};
    Parameter for_all = make_float("elsewhere", 1);
    for_all.may_be_unused = true;
    node.parameters.push_back(for_all);
    thing = things().make(node, context, "widget");
    auto* w = static_cast<const Widget*>(thing.get());
    ASSERT_NE(w, nullptr) << message();
    EXPECT_EQ(w->radius, 0.5f);
    EXPECT_EQ(w->count, 7) << "a part's own parameter";
    EXPECT_FALSE(w->hollow);
    EXPECT_EQ(*w->height, 2);
    EXPECT_TRUE(w->weights.empty()) << "one is out of range";
    EXPECT_EQ(message(), "warning: unknown thing \"gizmo\"; known: widget; using \"widget\" "
                         "instead, without \"hollow\", \"spin\", \"widget.radius\", \"weights\"");
}

TEST_F(FieldsTest, WithoutASubstituteTheThingIsLeftOut) {
    BuildContext context{messages};
    Node node;
    node.type = "zzzzzz";
    EXPECT_EQ(things().make(node, context, ""), nullptr);
    EXPECT_EQ(message(), "error: unknown thing \"zzzzzz\"; known: widget; --lenient would leave it out");
}

} // namespace

} // namespace alhazen
