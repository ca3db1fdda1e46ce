// Describes transfer and its record.

#include "cli/report/transfer_words.h"

#include "bake/gltf/write_set.h"
#include "runtime/core/support/counted.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace prt::pipeline {

std::vector<std::string> predictor_names(const ClusteredBases& bases) {
    std::vector<std::string> names;
    for (const Predictor& predictor : bases.predictors)
        names.emplace_back(to_string(predictor.kind));
    return names;
}

Json terms_figures(const TransferLayout& layout) {
    return terms_json(layout); // as in a file
}

std::string terms_in_words(const TransferLayout& layout) {
    std::vector<std::string> words;
    for (const TransferTerm& term : layout.distant_terms())
        words.push_back(words.empty()
                            ? fmt::format("{} of {} light", term.channels == 1 ? "1 channel" : "3 channels",
                                          to_string(term.kind))
                            : fmt::format("{} of {}", term.channels, to_string(term.kind)));
    if (const std::size_t lamps = layout.lamps(); lamps > 0)
        words.push_back(counted(lamps, "lamp"));
    return fmt::format("{}", fmt::join(words, ", "));
}

Json bake_record_json(const BakeRecord& record) {
    return {{"method", to_string(record.method)},
            {"backend", to_string(record.backend)},
            {"rays_per_receiver", record.rays},
            {"bounces", record.bounces},
            {"seed", record.seed},
            {"receivers_id", record.receivers},
            {"endless", record.endless},
            {"fitted", record.fitted},
            {"sampling_error_relative_l2", record.sampling_error}};
}

} // namespace prt::pipeline
