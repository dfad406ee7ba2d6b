"""Rules of the project that can be checked by reading its files: sizes, inheritance, documents, references."""
import ast
import builtins
import importlib.util
import re
import tokenize
from pathlib import Path

import pytest

import rockwear

ROOT = Path(__file__).resolve().parents[1]
PRODUCT = [file for folder in ("rockwear", "calibration", "yade_scripts")
           for file in sorted((ROOT / folder).rglob("*.py"))]
CODE = PRODUCT + sorted((ROOT / "tests").rglob("*.py"))
RESULTS = sorted((ROOT / "calibration/results").rglob("*.md"))
README, CHANGELOG = ROOT / "README.md", ROOT / "CHANGELOG.md"
LONGEST_LINE, LONGEST_README, LONGEST_CLASS, MOST_METHODS = 120, 120, 300, 25
NOT_OURS = {"object", "ABC", "NamedTuple", *(name for name in dir(builtins) if name.endswith(("Error", "Exception")))}


def name(file):
    """The file's path as it is said in a message."""
    return file.relative_to(ROOT).as_posix()


def none_of(found):
    """Fails with one line for each thing found."""
    assert not found, "\n" + "\n".join(sorted(found))


def read(file):
    """Text of a file."""
    return file.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def trees():
    """{file: its syntax tree} of all Python files."""
    return {file: ast.parse(read(file)) for file in CODE}


@pytest.fixture(scope="module")
def classes(trees):
    """[(where, node)] of all classes of the product."""
    return [(f"{name(file)}: {node.name}", node) for file in PRODUCT for node in ast.walk(trees[file])
            if isinstance(node, ast.ClassDef)]


def bases_of(node):
    """Names of a class's direct bases, without their modules."""
    return [base.attr if isinstance(base, ast.Attribute) else base.id for base in node.bases
            if isinstance(base, (ast.Attribute, ast.Name))]


def methods_of(node):
    """{name: node} of a class's own methods; a property with a setter is one."""
    return {item.name: item for item in node.body if isinstance(item, (ast.FunctionDef, ast.AsyncFunctionDef))}


def is_abstract(node):
    """Whether the class is an abstract base: it names ABC or has an abstract method."""
    decorators = [text for method in methods_of(node).values() for text in map(ast.unparse, method.decorator_list)]
    return "ABC" in bases_of(node) or any(text.endswith("abstractmethod") for text in decorators)


def lineage(node, found):
    """The longest chain of the project's own classes from this one upwards, itself included."""
    parents = [lineage(found[base], found) for base in bases_of(node) if base in found and found[base] is not node]
    return [node, *max(parents, key=len, default=[])]


def does_nothing(method):
    """Whether a method only passes, or returns a constant or nothing."""
    body = [part for part in method.body if not (isinstance(part, ast.Expr) and isinstance(part.value, ast.Constant))]
    empty = [part for part in body if isinstance(part, ast.Pass) or isinstance(part, ast.Return)
             and (part.value is None or isinstance(part.value, ast.Constant)
                  or isinstance(part.value, (ast.Tuple, ast.List)) and not part.value.elts
                  or isinstance(part.value, ast.Dict) and not part.value.keys)]
    return len(empty) == len(body)


def test_changelog_begins_with_this_version():
    versions = re.findall(r"^## (\d+\.\d+\.\d+)", read(CHANGELOG), re.MULTILINE)
    assert versions[0] == rockwear.__version__


def test_readme_is_short():
    assert len(read(README).splitlines()) <= LONGEST_README


def test_lines_are_short():
    """Rows of tables on result pages are exempt: commands write them."""
    long = [f"{name(file)}:{number} ({len(line)})" for file in [*CODE, README, CHANGELOG, *RESULTS]
            for number, line in enumerate(read(file).splitlines(), 1)
            if len(line) > LONGEST_LINE and not (file in RESULTS and line.startswith("|"))]
    none_of(long)


def test_links_lead_to_files():
    broken = [f"{name(page)}: {target}" for page in [README, CHANGELOG, *RESULTS]
              for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", read(page))
              if "://" not in target and not (page.parent / target).exists()]
    none_of(broken)


def test_documents_name_what_exists(trees):
    """Scripts, modules and targets that the README and the result pages tell to run."""
    targets = set(re.findall(r"^([a-z-]+):", read(ROOT / "Makefile"), re.MULTILINE))
    scripts = {file.name for file in PRODUCT if file.parent.name == "yade_scripts"}
    # The names of all parameters: the first argument of Parameter(...).
    parameters = {node.args[0].value for file in PRODUCT for node in ast.walk(trees[file])
                  if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("Parameter")
                  and node.args and isinstance(node.args[0], ast.Constant)}
    missing = []
    for page in [README, *RESULTS]:
        text = read(page)
        found = {
            "target": [word for word in re.findall(r"\bmake ([a-z-]+)`|^    make ([a-z-]+)", text, re.MULTILINE)
                       for word in word if word and word not in targets],
            "script": [word for word in re.findall(r"yade_scripts/(\w+\.py)", text) if word not in scripts],
            "module": [word for word in re.findall(r"-m ((?:rockwear|calibration)[\w.]*\w)", text)
                       if importlib.util.find_spec(word) is None],
            "parameter": [word for line in text.splitlines() if ".py" in line
                          for word in re.findall(r"--(\w+)", line.split(".py", 1)[1])
                          if word not in parameters | {"help", "full"}]}
        missing += [f"{name(page)}: {kind} {word}" for kind, words in found.items() for word in words]
    none_of(missing)


def test_every_scene_is_in_the_table_and_in_a_test(trees):
    """Tests start a script by its name, or by its path in yade_scripts/; campaign-wear starts the ripper."""
    scripts = {file.stem for file in PRODUCT if file.parent.name == "yade_scripts"} - {"find_rockwear"}
    table = "\n".join(line for line in read(README).splitlines() if line.startswith("| `"))
    none_of({f"README: {script}" for script in scripts if f"`{script}.py`" not in table})
    words = {node.value for file, tree in trees.items() if name(file).startswith("tests/scenes/test_")
             for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    started = {script for script in scripts if words & {script, f"yade_scripts/{script}.py"}}
    none_of({f"tests/scenes: {script}" for script in scripts - started - {"ripper"}})


def test_sources_are_cited_by_resolvable_keys():
    """[Rojek 2003, 9.2], not "M 9.2" or "M's"."""
    private = re.compile(r"\b[MPRV]['’]s\b|\b[MPRV] \d+(\.\d+)*\b")
    found = [f"{name(file)}:{number}" for file in [*CODE, README, *RESULTS] if file != Path(__file__).resolve()
             for number, line in enumerate(read(file).splitlines(), 1) if private.search(line)]
    none_of(found)


def test_every_key_is_in_readme_and_package_docstring():
    keys = {key for file in [*PRODUCT, README, *RESULTS]
            for key in re.findall(r"\[((?:Rojek|Bahaaddini) \d{4}|Rocky)[\],]", read(file))}
    none_of({key for key in keys if f"[{key}]" not in rockwear.__doc__ or f"[{key}]" not in read(README)})


def test_pytest_takes_no_product_file_for_a_test():
    none_of([name(file) for file in PRODUCT if re.fullmatch(r"test_.*|.*_test|conftest", file.stem)])


def test_one_place_finds_the_package(trees):
    found = {name(file) for file, tree in trees.items() for node in ast.walk(tree)
             if isinstance(node, ast.Call) and ast.unparse(node.func) in ("sys.path.insert", "sys.path.append")}
    assert found == {"yade_scripts/find_rockwear.py"}


def test_no_comment_silences_a_checker():
    found = []
    for file in CODE:
        with tokenize.open(file) as lines:
            found += [f"{name(file)}:{token.start[0]}" for token in tokenize.generate_tokens(lines.readline)
                      if token.type == tokenize.COMMENT and re.search("noqa|type: *ignore|pylint", token.string)]
    none_of(found)


def test_modules_have_docstrings(trees):
    """But for the empty files that make packages of the tests' folders."""
    none_of([name(file) for file, tree in trees.items() if not ast.get_docstring(tree)
             and not (file.name == "__init__.py" and name(file).startswith("tests/"))])


def test_imports_are_absolute(trees):
    none_of([f"{name(file)}:{node.lineno}" for file, tree in trees.items() for node in ast.walk(tree)
             if isinstance(node, ast.ImportFrom) and node.level])


def test_classes_are_small(classes):
    sizes = {where: (node.end_lineno - node.lineno + 1, len(methods_of(node))) for where, node in classes}
    none_of([f"{where}: {lines} lines, {methods} methods" for where, (lines, methods) in sizes.items()
             if lines > LONGEST_CLASS or methods > MOST_METHODS])


def test_a_base_has_a_name_of_its_own(classes):
    """The next tests find a base by its name."""
    names = [node.name for _, node in classes]
    none_of({base for _, node in classes for base in bases_of(node) if names.count(base) > 1})


def test_inheritance_has_two_levels(classes):
    """A class and its parent; both may stand below one abstract base."""
    found = {node.name: node for _, node in classes}
    chains = {where: lineage(node, found) for where, node in classes}
    none_of([f"{where} < {' < '.join(node.name for node in chain[1:])}" for where, chain in chains.items()
             if len(chain) > 3 or sum(not is_abstract(node) for node in chain) > 2])


def test_every_constructor_calls_its_parents(classes):
    missing = [where for where, node in classes
               if set(bases_of(node)) - NOT_OURS and "__init__" in methods_of(node)
               and not any(isinstance(call, ast.Call) and ast.unparse(call.func) == "super().__init__"
                           for call in ast.walk(methods_of(node)["__init__"]))]
    none_of(missing)


def test_no_subclass_disables_a_method(classes):
    """A method that does something in a parent does something in the child."""
    found = {node.name: node for _, node in classes}
    disabled = [f"{where}.{method}" for where, node in classes for method, body in methods_of(node).items()
                for parent in lineage(node, found)[1:]
                if does_nothing(body) and method in methods_of(parent) and not does_nothing(methods_of(parent)[method])
                and not any("abstractmethod" in ast.unparse(d) for d in methods_of(parent)[method].decorator_list)]
    none_of(disabled)
