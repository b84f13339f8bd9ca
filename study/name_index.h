#pragma once
// The index of a name in a list that grows, by hash: tables may hold hundreds of thousands of names.

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace palpa::study {

class NameIndex {
  public:
    // `names` must outlive the index, and grow only through it.
    explicit NameIndex(std::vector<std::string>& names) : names_(&names) {
        for (std::size_t i = 0; i < names.size(); ++i) at_.emplace(names[i], static_cast<int>(i));
    }

    // Returns the index of `name`, which is added if it is new.
    int of(std::string_view name) {
        const auto it = at_.find(name);
        if (it != at_.end()) return it->second;
        names_->emplace_back(name);
        const int index = static_cast<int>(names_->size()) - 1;
        at_.emplace(name, index);
        return index;
    }

  private:
    struct Hash {
        using is_transparent = void;
        std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>()(text); }
    };
    std::vector<std::string>* names_;
    std::unordered_map<std::string, int, Hash, std::equal_to<>> at_;
};

}  // namespace palpa::study
