#include "base/messages.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

namespace alhazen {

namespace {

std::string join_messages(const std::vector<Message>& messages) {
    std::string all;
    for (const Message& m : messages) {
        if (!all.empty()) all += '\n';
        all += m.full_text();
    }
    return all;
}

// By line and column within each file; the files in the order of their first messages.
std::vector<Message> in_order(std::vector<Message> messages) {
    std::unordered_map<std::string, std::size_t> ranks;
    auto rank = [&](const Message& m) {
        return ranks.try_emplace(m.place.file ? *m.place.file : "", ranks.size()).first->second;
    };
    for (const Message& m : messages) rank(m);
    std::stable_sort(messages.begin(), messages.end(), [&](const Message& a, const Message& b) {
        return std::tuple(rank(a), a.place.line, a.place.column) <
               std::tuple(rank(b), b.place.line, b.place.column);
    });
    return messages;
}

bool is_earlier(const Place& a, const Place& b) {
    return a.file && b.file && *a.file == *b.file &&
           std::tuple(a.line, a.column) < std::tuple(b.line, b.column);
}

// Damerau-Levenshtein distance (optimal string alignment), ignoring case.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    auto low = [](char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c); };
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        now[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            std::size_t change = last[j - 1] + (low(a[i - 1]) == low(b[j - 1]) ? 0 : 1);
            now[j] = std::min({last[j] + 1, now[j - 1] + 1, change});
            if (i > 1 && j > 1 && low(a[i - 1]) == low(b[j - 2]) && low(a[i - 2]) == low(b[j - 1]))
                now[j] = std::min(now[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, now);
    }
    return last[b.size()];
}

} // namespace

Place Place::of_file(std::string path) {
    return {std::make_shared<const std::string>(std::move(path)), 0, 0};
}

std::string Place::text() const {
    if (!file) return "";
    if (line == 0) return *file;
    return fmt::format("{}:{}:{}", *file, line, column);
}

std::string Message::full_text() const {
    std::string where = place.text();
    return fmt::format("{}{}{}: {}", where, where.empty() ? "" : ": ",
                       kind == Kind::error ? "error" : "warning", text);
}

SceneError::SceneError(std::vector<Message> messages)
    : std::runtime_error(join_messages(messages = in_order(std::move(messages)))),
      messages_(std::move(messages)) {}

SceneError::SceneError(Place place, std::string text)
    : SceneError(std::vector<Message>{{Message::Kind::error, std::move(place), std::move(text)}}) {}

Remedy Remedy::use(std::string_view substitute, std::string_view note) {
    return {fmt::format("use {} instead{}", substitute, note),
            fmt::format("using {} instead{}", substitute, note)};
}

void Messages::add_error(Place place, std::string text) {
    std::scoped_lock lock(mutex_);
    list_.push_back({Message::Kind::error, std::move(place), std::move(text)});
    if (++errors_ >= max_errors) throw SceneError(counted_list());
}

void Messages::add_warning(Place place, std::string text) {
    std::scoped_lock lock(mutex_);
    auto [same, is_new] = warnings_.try_emplace(text, Repeated{list_.size()});
    if (is_new) {
        list_.push_back({Message::Kind::warning, std::move(place), std::move(text)});
        return;
    }
    ++same->second.more;
    // The threads that load shapes may come in any order.
    Place& kept = list_[same->second.index].place;
    if (is_earlier(place, kept)) kept = std::move(place);
}

void Messages::add_unsupported(Place place, std::string text, const Remedy& remedy) {
    if (lenient)
        add_warning(std::move(place), fmt::format("{}; {}", text, remedy.doing));
    else
        add_error(std::move(place), fmt::format("{}; --lenient would {}", text, remedy.would));
}

std::vector<Message> Messages::counted_list() const {
    std::vector<Message> counted = list_;
    for (const auto& [text, repeated] : warnings_)
        if (repeated.more > 0)
            counted[repeated.index].text += fmt::format(" (and {} more like this)", repeated.more);
    return counted;
}

std::size_t Messages::error_count() const {
    std::scoped_lock lock(mutex_);
    return errors_;
}

std::vector<Message> Messages::list() const {
    std::scoped_lock lock(mutex_);
    return in_order(counted_list());
}

std::vector<Message> Messages::warnings() const {
    std::vector<Message> all = list();
    std::erase_if(all, [](const Message& m) { return m.kind != Message::Kind::warning; });
    return all;
}

void Messages::throw_if_errors() const {
    std::scoped_lock lock(mutex_);
    if (errors_ > 0) throw SceneError(counted_list());
}

std::string ordinal(std::size_t n) {
    bool is_teen = n / 10 % 10 == 1;
    std::size_t last = n % 10;
    std::string_view ending = is_teen ? "th" : last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th";
    return fmt::format("{}{}", n, ending);
}

std::string nearest_name(std::string_view word, std::span<const std::string> candidates) {
    if (word.size() > 64) return "";
    const std::string* best = nullptr;
    std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        std::size_t d = edit_distance(word, candidate);
        if (d < best_distance) {
            best_distance = d;
            best = &candidate;
        }
    }
    return best ? *best : "";
}

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
    std::string nearest = nearest_name(word, candidates);
    if (!nearest.empty()) return fmt::format(" (did you mean \"{}\"?)", nearest);
    std::string known;
    for (const std::string& candidate : candidates) {
        if (known.size() + candidate.size() > 300) {
            known += ", ...";
            break;
        }
        known += (known.empty() ? "" : ", ") + candidate;
    }
    return known.empty() ? "" : "; known: " + known;
}

} // namespace alhazen
