// The page of a library: person and robot beside each other, and every figure with its limit.
#pragma once

#include "library_page/judgement.hpp"
#include "pages/page.hpp"
#include "retargeting/library_review.hpp"

namespace pmg::library_page {

pages::Page page_of(const retargeting::LibraryReview& review, const Measured& measured,
                    const retargeting::ClipGoals& goals = {});

}  // namespace pmg::library_page
