#!/usr/bin/env python3
"""Whether modelDescription.xml of unpacked FMUs says what FMI 3.0 has it say, and whether their
packages are whole.

What is asked for are facts of the standard's schema and text: which elements in which order, which
attributes with which values, what a variable of which causality has, what has to be listed in
ModelStructure.

usage: describe.py FOLDER..."""
import os
import re
import sys
import xml.etree.ElementTree as xml

ORDER = ["ModelExchange", "CoSimulation", "ScheduledExecution", "UnitDefinitions", "TypeDefinitions",
         "LogCategories", "DefaultExperiment", "ModelVariables", "ModelStructure", "Annotations"]
ROOT = {"fmiVersion", "modelName", "instantiationToken", "description", "author", "version",
        "copyright", "license", "generationTool", "generationDateAndTime",
        "variableNamingConvention"}
COMMON = {"modelIdentifier", "needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess",
          "canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives",
          "providesAdjointDerivatives", "providesPerElementDependencies"}
EXCHANGE = COMMON | {"needsCompletedIntegratorStep", "providesEvaluateDiscreteStates"}
SIMULATION = COMMON | {"canHandleVariableCommunicationStepSize", "fixedInternalStepSize",
                       "maxOutputDerivativeOrder", "recommendedIntermediateInputSmoothness",
                       "providesIntermediateUpdate", "mightReturnEarlyFromDoStep",
                       "canReturnEarlyAfterIntermediateUpdate", "hasEventMode",
                       "providesEvaluateDiscreteStates"}
VARIABLE = {"name", "valueReference", "description", "causality", "variability",
            "canHandleMultipleSetPerTimeInstant", "intermediateUpdate", "previous", "clocks",
            "declaredType", "quantity", "unit", "displayUnit", "relativeQuantity", "unbounded",
            "min", "max", "nominal", "derivative", "reinit", "initial", "start"}
# causality: the variabilities and initials that go with it, of those that the standard's table allows
ALLOWED = {
    "independent": {("continuous", None)},
    "parameter": {("fixed", "exact"), ("tunable", "exact")},
    "input": {("discrete", None), ("continuous", None), ("discrete", "exact"), ("continuous", "exact")},
    "output": {(v, i) for v in ("discrete", "continuous") for i in ("exact", "approx", "calculated")},
    "local": {(v, i) for v in ("discrete", "continuous") for i in ("exact", "approx", "calculated")},
}
BASES = {"kg", "m", "s", "A", "K", "mol", "cd", "rad", "factor", "offset"}
NUMBER = re.compile(r"[-+]?\d+(\.\d*)?([eE][-+]?\d+)?\Z")


def check(fact, what):
    if not fact:
        raise AssertionError(what)


def check_root(root):
    check(root.tag == "fmiModelDescription" and set(root.attrib) <= ROOT, root.attrib)
    check(root.get("fmiVersion") == "3.0", root.get("fmiVersion"))
    check(root.get("modelName") and root.get("instantiationToken"), "name and token")
    check(root.get("variableNamingConvention", "flat") in ("flat", "structured"), "convention")
    places = [ORDER.index(child.tag) for child in root]
    check(places == sorted(set(places)), [child.tag for child in root])
    check({"ModelVariables", "ModelStructure"} <= {child.tag for child in root}, "elements")


def check_interfaces(root, folder):
    found = 0
    for tag, known in (("ModelExchange", EXCHANGE), ("CoSimulation", SIMULATION)):
        element = root.find(tag)
        if element is None:
            continue
        found += 1
        check(set(element.attrib) <= known, element.attrib)
        name = element.get("modelIdentifier")
        check(re.fullmatch(r"[A-Za-z_]\w*", name), name)
        machine = os.uname().machine
        check(os.path.exists(f"{folder}/binaries/{machine}-linux/{name}.so"), f"{name}.so")
        check(element.get("canGetAndSetFMUState") == "true" or element.get("canSerializeFMUState") != "true",
              "states that are serialised can be got and set")
        for attribute, value in element.attrib.items():
            if attribute not in ("modelIdentifier", "fixedInternalStepSize", "maxOutputDerivativeOrder"):
                check(value in ("true", "false"), (attribute, value))
    check(found, "an FMU has an interface")


def check_units(root):
    names = [unit.get("name") for unit in root.iter("Unit")]
    check(len(names) == len(set(names)), names)
    for base in root.iter("BaseUnit"):
        check(set(base.attrib) <= BASES and all(int(v) for v in base.attrib.values()), base.attrib)
    return set(names)


def check_variable(variable, units):
    name = variable.get("name")
    check(variable.tag == "Float64" and set(variable.attrib) <= VARIABLE, (name, variable.attrib))
    kind = (variable.get("variability"), variable.get("initial"))
    check(kind in ALLOWED[variable.get("causality")], (name, kind))
    check(variable.get("unit") is None or variable.get("unit") in units, (name, variable.get("unit")))
    check(name and "\n" not in name, name)
    # who has a start value: parameters and inputs have to, what is calculated may not
    start = variable.get("start")
    if variable.get("causality") in ("parameter", "input"):
        check(start is not None and NUMBER.match(start), (name, start))
    else:
        check(start is None, (name, start))
    for child in variable:
        check(child.tag == "Dimension" and int(child.get("start")) > 0, (name, child.tag))


def check_variables(root, units):
    variables = {}
    names = set()
    for variable in root.find("ModelVariables"):
        check_variable(variable, units)
        reference = int(variable.get("valueReference"))
        check(reference not in variables and variable.get("name") not in names, reference)
        variables[reference] = variable
        names.add(variable.get("name"))
    independent = [v for v in variables.values() if v.get("causality") == "independent"]
    check(len(independent) == 1 and independent[0].get("name") == "time", "one independent variable")
    return variables


def size(variable):
    return int(variable[0].get("start")) if len(variable) else 1


def check_structure(root, variables):
    listed = {}
    order = ["Output", "ContinuousStateDerivative", "ClockedState", "InitialUnknown", "EventIndicator"]
    places = [order.index(child.tag) for child in root.find("ModelStructure")]
    check(places == sorted(places), "order of ModelStructure")
    slopes = {r for r, v in variables.items() if v.get("derivative") is not None}
    states = {int(variables[r].get("derivative")) for r in slopes}
    inputs = {r for r, v in variables.items() if v.get("causality") in ("input", "independent")}
    for child in root.find("ModelStructure"):
        reference = int(child.get("valueReference"))
        check(reference in variables, reference)
        listed.setdefault(child.tag, []).append(reference)
        known = child.get("dependencies")
        if known is not None:
            known = [int(k) for k in known.split()]
            check(len(known) == len(set(known)) and set(known) <= inputs | states, (reference, known))
    outputs = {r for r, v in variables.items() if v.get("causality") == "output"}
    check(sorted(listed.get("Output", [])) == sorted(outputs), "all outputs, each once")
    check(sorted(listed.get("ContinuousStateDerivative", [])) == sorted(slopes), "all derivatives")
    calculated = {r for r in outputs | slopes | states
                  if variables[r].get("initial") in ("approx", "calculated")}
    check(sorted(listed.get("InitialUnknown", [])) == sorted(calculated), "all initial unknowns")
    for reference in slopes:
        of = variables[int(variables[reference].get("derivative"))]
        check(size(of) == size(variables[reference]), of.get("name"))
        check(of.get("variability") == "continuous" and float(of.get("nominal")) > 0, of.get("name"))
    check(bool(slopes) == (root.find("ModelExchange") is not None), "states are for Model Exchange")


def check_experiment(root):
    experiment = root.find("DefaultExperiment")
    for name in experiment.attrib:
        check(name in ("startTime", "stopTime", "tolerance", "stepSize"), name)
        check(NUMBER.match(experiment.get(name)), experiment.get(name))
    check(float(experiment.get("stopTime")) > float(experiment.get("startTime")), "times")


def check_package(folder):
    for name in ("resources/scenario.json", "documentation/licenses/license.txt"):
        check(os.path.exists(f"{folder}/{name}"), name)
    with open(f"{folder}/resources/scenario.json") as lines:
        text = lines.read()
    check('"/' not in text, "a name with a folder in the resources")
    for name in os.listdir(f"{folder}/resources"):
        check(name == "scenario.json" or f'"{name}"' in text, f"{name} is of no use")


def check_fmu(folder):
    root = xml.parse(f"{folder}/modelDescription.xml").getroot()
    check_root(root)
    check_interfaces(root, folder)
    variables = check_variables(root, check_units(root))
    check_structure(root, variables)
    check_experiment(root)
    check_package(folder)
    return root, {v.get("name"): v for v in variables.values()}


def check_driven(root, by_name):
    """What the fixture of that name has to have."""
    check(root.find("ModelExchange").get("providesDirectionalDerivatives") == "true", "derivatives")
    push, flesh = by_name["push"], by_name["flesh"]
    check((push.get("variability"), float(push.get("start"))) == ("continuous", 0.5), push.attrib)
    check((flesh.get("variability"), float(flesh.get("start"))) == ("discrete", 1.0), flesh.attrib)
    mu = by_name["material.mu"]
    check((float(mu.get("start")), mu.get("unit")) == (1e4, "Pa"), mu.attrib)
    check(by_name["hold.mx"].get("unit") == "N m", "unit of a moment")
    structure = {c.get("valueReference"): c for c in root.find("ModelStructure").iter("Output")}
    u = by_name["body.u"].get("valueReference")
    check(structure[by_name["corner.ux"].get("valueReference")].get("dependencies") == u, "corner.ux")
    check(structure[by_name["push.ax"].get("valueReference")].get("dependencies") is None, "push.ax")
    worst = structure[by_name["worst.value"].get("valueReference")].get("dependencies").split()
    check(sorted(worst) == sorted([u, flesh.get("valueReference")]), worst)


def check_myself(folder):
    """A description that is wrong is found."""
    for change in (("valueReference=\"1\"", "valueReference=\"2\""), ("\"output\"", "\"result\""),
                   ("<Output valueReference", "<InitialUnknown valueReference"),
                   (" start=\"", " begin=\""), ("fmiVersion=\"3.0\"", "fmiVersion=\"2.0\"")):
        with open(f"{folder}/modelDescription.xml") as lines:
            text = lines.read()
        wrong = text.replace(*change, 1)
        check(wrong != text, change)
        root = xml.fromstring(wrong)
        try:
            check_root(root)
            check_structure(root, check_variables(root, check_units(root)))
        except (AssertionError, KeyError):
            continue
        raise AssertionError(f"not found: {change}")


def main():
    folders = sys.argv[1:]
    if not folders:
        sys.exit(__doc__)
    for folder in folders:
        try:
            found = check_fmu(folder)
            if os.path.basename(folder) == "driven":
                check_driven(*found)
                check_myself(folder)
        except (AssertionError, KeyError) as error:
            sys.exit(f"FAILED: {folder}: {error!r}")
    print(f"{len(folders)} descriptions: no offence")


main()
