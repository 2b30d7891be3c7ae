#pragma once

#include <kainjow/mustache.hpp>

#include "run_data.hpp"

/// The report's sections as data for the templates: each function fills the keys that its part of
/// run.html reads. Texts are plain; the template engine escapes them.
namespace traverse::report {

using TemplateData = kainjow::mustache::data;

void add_verdict(const RunData& run, TemplateData& page);
void add_accuracy(const RunData& run, TemplateData& page);
void add_health(const RunData& run, TemplateData& page);
void add_timing(const RunData& run, TemplateData& page);
void add_factors(const RunData& run, TemplateData& page);
void add_navigation(const RunData& run, TemplateData& page);
void add_provenance(const RunData& run, TemplateData& page);

}  // namespace traverse::report
