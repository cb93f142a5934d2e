// What a model's maker needs to read its settings and to declare its parameters.
#pragma once
#include <initializer_list>
#include <limits>
#include <string>

#include "continuum/model.h"

namespace grainfield::continuum {

/// Parameter::least of a number that must be above zero: below, products of a few underflow.
inline constexpr double kAboveZero = 1e-60;
/// Parameter::most (and minus it, least) of a number without a bound of its own: beyond, products
/// of a few overflow.
inline constexpr double kUnbounded = 1e60;

/// A numerical parameter.
Parameter number(std::string name, std::string unit, std::string meaning, std::string source,
                 double value, double least, double most);
/// A numerical parameter without a default: unset, number_of() gives nan and the meaning says what
/// holds.
Parameter optional_number(std::string name, std::string unit, std::string meaning,
                          std::string source, double least, double most);
/// The same parameter, which may be free in a fit: the search keeps to least < value < most.
Parameter may_be_free(Parameter parameter, double least, double most,
                      double floor = -std::numeric_limits<double>::infinity());
/// This parameter, without effect unless the parameter `other` is one of these words.
Parameter only_with(Parameter parameter, std::string other, std::vector<std::string> words);
/// A numerical parameter that takes whole numbers only.
Parameter whole_number(std::string name, std::string meaning, std::string source, int value,
                       int least, int most);
/// A parameter of any text, e.g. a file, empty by default; its unit is "text".
Parameter text(std::string name, std::string meaning, std::string source);
/// A parameter of words; the first choice is the default.
Parameter choice(std::string name, std::string meaning, std::string source,
                 std::vector<std::string> choices);
bool is_text(const Parameter& parameter);
/// All of these, in their order.
std::vector<Parameter> joined(std::initializer_list<std::vector<Parameter>> parts);

/// The settings with every missing parameter at its default. Throws BadParameter naming the model,
/// the parameter, the value found, what is allowed and the nearest valid name or choice.
Settings complete(const ModelInfo& info, const Settings& settings);

/// The number of a parameter in settings that complete() returned.
double number_of(const Settings& settings, const std::string& name);
/// Its number, or `standard` where it is 0.
double nonzero_or(const Settings& settings, const std::string& name, double standard);

}  // namespace grainfield::continuum
