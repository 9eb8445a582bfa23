#include "src/requirement/parse_formula.h"

#include <algorithm>
#include <array>
#include <boost/spirit/home/x3.hpp>
#include <functional>

// Defines the grammar of requirement formulas. Wherever several grammar rules are possible, the
// next word determines the rule, so the parser never parses a text twice. Every recursive grammar
// rule first calls FormulaBuilder::Open or OpenParenthesis, which limit the nesting depth. An error
// message names the grammar rule that was expected.
namespace trackbed {
namespace formula_grammar {
namespace {

namespace x3 = boost::spirit::x3;
namespace ascii = boost::spirit::x3::ascii;

struct BuilderTag;

template <typename Context>
FormulaBuilder& Builder(const Context& context) {
  return x3::get<BuilderTag>(context).get();
}

template <typename Context>
std::string_view Matched(const Context& context) {
  const auto& range = x3::_attr(context);
  return {range.begin(), static_cast<std::size_t>(range.end() - range.begin())};
}

/// Returns a parser action that begins an operation.
auto Open(FormulaOperation operation) {
  return [operation](auto& context) { Builder(context).Open(operation, Matched(context)); };
}

const auto close = x3::eps[([](auto& context) { Builder(context).Close(); })];
const auto fold_argument = x3::eps[([](auto& context) { Builder(context).FoldArgument(); })];

const auto name_character = ascii::char_("a-zA-Z0-9_");

auto Keyword(const char* word) {
  return x3::raw[x3::lexeme[x3::lit(word) >> !name_character]];
}

constexpr std::array kKeywords{"and",        "or",    "not", "implies", "always",
                               "eventually", "until", "abs", "min",     "max"};

const auto add_signal = [](auto& context) {
  const std::string_view name = Matched(context);
  x3::_pass(context) = std::find(kKeywords.begin(), kKeywords.end(), name) == kKeywords.end();
  if (x3::_pass(context)) {
    Builder(context).AddSignal(name);
  }
};
const auto add_number = [](auto& context) { Builder(context).AddNumber(Matched(context)); };
const auto add_bound = [](auto& context) { Builder(context).AddBound(Matched(context)); };
const auto add_bound_from_end = [](auto& context) {
  Builder(context).AddBoundFromEnd(Matched(context));
};
const auto refuse_chain = [](auto& context) {
  Builder(context).Fail(Matched(context).data(),
                        "comparisons cannot be chained; write 'a < x and x < b'");
};
const auto refuse_until = [](auto& context) {
  Builder(context).Fail(Matched(context).data(), "'until' after 'until' needs parentheses");
};

const x3::rule<struct FormulaRule> formula = "a condition";
const x3::rule<struct DisjunctionRule> disjunction = "a condition";
const x3::rule<struct ConjunctionRule> conjunction = "a condition";
const x3::rule<struct UntilRule> until = "a condition";
const x3::rule<struct TemporalRule> temporal = "a condition";
const x3::rule<struct ComparisonRule> comparison = "a condition";
const x3::rule<struct SumRule> sum = "a number or signal";
const x3::rule<struct ProductRule> product = "a number or signal";
const x3::rule<struct SignedRule> signed_value = "a number or signal";
const x3::rule<struct ValueRule> value = "a number or signal";
const x3::rule<struct ArgumentRule> argument = "a number or signal";
const x3::rule<struct WindowRule> window = "a window";
const x3::rule<struct BoundRule> bound = "a time in seconds, or T";
const x3::rule<struct OffsetRule> offset = "a time in seconds";
const x3::rule<struct FurtherRule> further_arguments = "','";
const x3::rule<struct FunctionEndRule> end_of_function = "')'";
const x3::rule<struct ParenthesisEndRule> end_of_parenthesis = "')'";
const x3::rule<struct EndRule> end_of_formula = "an operator or the end";

const auto number =
    x3::raw[x3::lexeme[((+ascii::digit >> -(x3::lit('.') >> *ascii::digit)) |
                        (x3::lit('.') >> +ascii::digit)) >>
                       -(ascii::char_("eE") >> -ascii::char_("+-") >> +ascii::digit)]];

const auto offset_def = number[add_bound_from_end];
const auto bound_def =
    number[add_bound] | (x3::lexeme[x3::lit('T') >> !name_character] >>
                         ((x3::lit('-') > offset) | x3::raw[x3::eps][add_bound_from_end]));
const auto window_def = x3::lit('[') > bound > ',' > bound > ']';

const auto argument_def = formula;
const auto further_arguments_def = +(x3::lit(',') > argument > fold_argument);
const auto end_of_function_def =
    x3::raw[x3::lit(')')]
           [([](auto& context) { Builder(context).CloseFunction(Matched(context)); })];
const auto end_of_parenthesis_def =
    x3::raw[x3::lit(')')]
           [([](auto& context) { Builder(context).CloseParenthesis(Matched(context)); })];

const auto function_def =
    (Keyword("abs")[Open(FormulaOperation::kAbs)] > '(' > argument > end_of_function) |
    ((Keyword("min")[Open(FormulaOperation::kMin)] | Keyword("max")[Open(FormulaOperation::kMax)]) >
     '(' > argument > further_arguments > end_of_function);

const auto parenthesis_def = x3::raw[x3::lit('(')][([](auto& context) {
                               Builder(context).OpenParenthesis(Matched(context));
                             })] > formula > end_of_parenthesis;

const auto value_def = number[add_number] | function_def | parenthesis_def |
                       x3::raw[x3::lexeme[ascii::char_("a-zA-Z_") >> *name_character]][add_signal];

const auto signed_value_def =
    (x3::raw[x3::lit('-')][Open(FormulaOperation::kNegate)] > signed_value > close) | value;

const auto product_def = signed_value >>
                         *((x3::raw[x3::lit('*')][Open(FormulaOperation::kMultiply)] |
                            x3::raw[x3::lit('/')][Open(FormulaOperation::kDivide)]) > signed_value >
                           close);

const auto sum_def = product >> *((x3::raw[x3::lit('+')][Open(FormulaOperation::kAdd)] |
                                   x3::raw[x3::lit('-')][Open(FormulaOperation::kSubtract)]) >
                                  product > close);

const auto comparison_def = sum >>
                            -((x3::raw[x3::lit("<=")][Open(FormulaOperation::kLessOrEqual)] |
                               x3::raw[x3::lit(">=")][Open(FormulaOperation::kGreaterOrEqual)] |
                               x3::raw[x3::lit('<')][Open(FormulaOperation::kLess)] |
                               x3::raw[x3::lit('>')][Open(FormulaOperation::kGreater)]) > sum >
                              close > -x3::raw[ascii::char_("<>")][refuse_chain]);

const auto temporal_def =
    (Keyword("not")[Open(FormulaOperation::kNot)] > temporal > close) |
    ((Keyword("always")[Open(FormulaOperation::kAlways)] |
      Keyword("eventually")[Open(FormulaOperation::kEventually)]) > -window > temporal > close) |
    comparison;

const auto until_def = temporal >> -(Keyword("until")[Open(FormulaOperation::kUntil)] > -window >
                                     temporal > close > -Keyword("until")[refuse_until]);

const auto conjunction_def = until >>
                             *(Keyword("and")[Open(FormulaOperation::kAnd)] > until > close);

const auto disjunction_def = conjunction >>
                             *(Keyword("or")[Open(FormulaOperation::kOr)] > conjunction > close);

const auto formula_def = disjunction >>
                         -(Keyword("implies")[Open(FormulaOperation::kImplies)] > formula > close);

const auto end_of_formula_def = x3::eoi;

BOOST_SPIRIT_DEFINE(formula, disjunction, conjunction, until, temporal, comparison, sum, product,
                    signed_value, value, argument, window, bound, offset, further_arguments,
                    end_of_function, end_of_parenthesis, end_of_formula)

}  // namespace
}  // namespace formula_grammar

void ParseFormula(std::string_view text, FormulaBuilder& builder) {
  namespace x3 = boost::spirit::x3;
  namespace grammar = formula_grammar;
  const char* first = text.data();
  const char* last = first + text.size();
  try {
    // Begin the rule with x3::eps, so that Boost.Spirit reports a mismatch at the first word in the
    // same way as a later mismatch (expectation failure).
    const auto whole = x3::with<grammar::BuilderTag>(
        std::ref(builder))[x3::eps > grammar::formula > grammar::end_of_formula];
    x3::phrase_parse(first, last, whole, x3::ascii::space);
  } catch (const x3::expectation_failure<const char*>& failure) {
    const auto is_space = [](char c) {
      return std::string_view(" \t\n\v\f\r").find(c) != std::string_view::npos;
    };
    builder.FailExpected(std::find_if_not(failure.where(), last, is_space), failure.which());
  }
}

}  // namespace trackbed
