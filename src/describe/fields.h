/// A parameter is declared once. Each kind of thing lists its members with a name and a meaning; the type
/// comes from the member and the default from its initialiser. Reading from every format, error messages, the
/// manual and the conformance tests' examples all come from that list.
///
///     struct Diffuse final : Material {
///         AlbedoTexture reflectance{0.5f};
///         static void describe(Fields<Diffuse>& f) {
///             f.about("Ideal matte surface: ...");
///             f.field("reflectance", &Diffuse::reflectance, "fraction of light reflected").in(0, 1);
///             f.example("clay", {make_rgb("reflectance", .6f, .4f, .3f)});
///         }
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "describe/context.h"
#include "describe/field_types.h"
#include "describe/scene_description.h"

namespace alhazen {

/// What the manual says of one parameter.
struct FieldDoc {
    std::string name;
    std::string type;         ///< "float", "rgb | spectrum | texture", "\"repeat\" | \"clamp\""
    std::string default_text; ///< "0.5"; "" when required
    std::string meaning;
    std::string unit;
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    bool lowest_is_excluded = false;
    bool is_required = false;
    /// Where a spectrum or image is too complex to check, the range holds for plain numbers only.
    bool has_range() const {
        return lowest > -std::numeric_limits<double>::infinity() ||
               highest < std::numeric_limits<double>::infinity();
    }
    std::string range_text() const;
};

/// A set of parameter values worth showing: documented, rendered, tested.
struct Example {
    std::string name;
    std::vector<Parameter> parameters;
};

/// What the manual says of one kind.
struct KindDoc {
    std::string name;
    std::string about;
    std::vector<FieldDoc> fields;
    std::vector<Example> examples;
};

/// Checks that numbers are finite and in the field's range; adds an error otherwise.
bool check_range(const FieldDoc& field, const Parameter& parameter, BuildContext& context);
/// Adds the error for a parameter that no field reads: "unknown parameter ... (did you mean ...)".
void report_unknown_parameter(const Parameter& parameter, std::string_view owner,
                              const std::vector<std::string>& known, BuildContext& context);
void report_missing_parameter(const FieldDoc& field, std::string_view owner, const Node& node,
                              BuildContext& context);

/// A node of a type that is not known, turned into one of a type that is.
struct Substitution {
    Node node;                        ///< its type is "" when there is nothing to take instead
    std::vector<std::string> dropped; ///< parameters that the new type does not read
};
/// The parameters that can_read says are read go over; "TYPE.name" goes over as "name".
Substitution substitute_node(const Node& node, std::string_view type,
                             const std::function<bool(const Parameter&)>& can_read);
void report_unknown_kind(const Node& node, std::string_view family, const std::vector<std::string>& known,
                         const Substitution& substitution, BuildContext& context);

/// The declared parameters of one kind T.
template <class T>
class Fields {
  public:
    struct Field {
        FieldDoc doc;
        std::function<void(T&, const Parameter&, BuildContext&)> read;
    };

    /// Adds range, unit and so on to the field just declared.
    class Refine {
      public:
        explicit Refine(FieldDoc& doc) : doc_(doc) {}
        Refine& in(double lowest, double highest) {
            doc_.lowest = lowest;
            doc_.highest = highest;
            return *this;
        }
        Refine& at_least(double lowest) {
            doc_.lowest = lowest;
            return *this;
        }
        /// Greater than, not equal.
        Refine& above(double lowest) {
            doc_.lowest = lowest;
            doc_.lowest_is_excluded = true;
            return *this;
        }
        Refine& unit(std::string unit) {
            doc_.unit = std::move(unit);
            return *this;
        }
        Refine& required() {
            doc_.is_required = true;
            doc_.default_text.clear();
            return *this;
        }
        /// Says the default in words where the initialiser does not tell it.
        Refine& otherwise(std::string text) {
            doc_.default_text = std::move(text);
            return *this;
        }

      private:
        FieldDoc& doc_;
    };

    Fields& about(std::string text) {
        about_ = std::move(text);
        return *this;
    }

    /// A member of T or of a base of T.
    template <class C, class M>
    Refine field(std::string name, M C::*member, std::string meaning) {
        static_assert(std::is_base_of_v<C, T>);
        return add(
            std::move(name), [member](T& object) -> M& { return object.*member; }, std::move(meaning));
    }
    /// A member of a part: a struct that several kinds have, or one has several of.
    template <class C, class P, class M>
    Refine field(std::string name, P C::*part, M P::*member, std::string meaning) {
        static_assert(std::is_base_of_v<C, T>);
        return add(
            std::move(name), [part, member](T& object) -> M& { return object.*part.*member; },
            std::move(meaning));
    }

    Fields& example(std::string name, std::vector<Parameter> parameters) {
        examples_.push_back({std::move(name), std::move(parameters)});
        return *this;
    }

    const std::vector<Field>& list() const { return fields_; }
    KindDoc doc(std::string name) const {
        KindDoc d{std::move(name), about_, {}, examples_};
        for (const Field& f : fields_) d.fields.push_back(f.doc);
        return d;
    }

  private:
    template <class Get>
    Refine add(std::string name, Get get, std::string meaning) {
        using M = std::remove_reference_t<std::invoke_result_t<Get, T&>>;
        Field f;
        f.doc.name = std::move(name);
        f.doc.type = FieldType<M>::type_text();
        f.doc.default_text = FieldType<M>::default_text(get(defaults_));
        f.doc.meaning = std::move(meaning);
        f.read = [get](T& object, const Parameter& parameter, BuildContext& context) {
            FieldType<M>::read(get(object), parameter, context);
        };
        fields_.push_back(std::move(f));
        return Refine(fields_.back().doc);
    }

    T defaults_{};
    std::string about_;
    std::vector<Field> fields_;
    std::vector<Example> examples_;
};

/// The fields of T, listed once a program.
template <class T>
const Fields<T>& fields_of() {
    static const Fields<T> fields = [] {
        Fields<T> f;
        T::describe(f);
        return f;
    }();
    return fields;
}

/// Sets the member of the parameter's name; false when T declares none. Adds an error when the value does not
/// fit.
template <class T>
bool read_field(T& object, const Parameter& parameter, BuildContext& context) {
    for (const auto& f : fields_of<T>().list()) {
        if (f.doc.name != parameter.name) continue;
        if (check_range(f.doc, parameter, context)) f.read(object, parameter, context);
        return true;
    }
    return false;
}

/// Sets object's members from the node's parameters. Adds an error for each parameter that is unknown, of the
/// wrong type or out of range, and for each required one that is absent. owner says whose they are in
/// messages: "material \"diffuse\"".
template <class T>
void read_fields(T& object, const Node& node, std::string_view owner, BuildContext& context) {
    const auto& fields = fields_of<T>().list();
    for (const Parameter& p : node.parameters) {
        if (read_field(object, p, context)) continue;
        std::vector<std::string> known;
        for (const auto& f : fields) known.push_back(f.doc.name);
        report_unknown_parameter(p, owner, known, context);
    }
    for (const auto& f : fields)
        if (f.doc.is_required && !node.find(f.doc.name))
            report_missing_parameter(f.doc, owner, node, context);
}

} // namespace alhazen
