# SPDX-License-Identifier: Apache-2.0
"""Reads what a scenario printed, and holds it against bounds."""

import json
import re


class Log:
    """Facts and JSON of a scenario, by name. What was not printed is None, and fits no bound."""

    def __init__(self, text):
        text = text.replace("\r", "")
        self.facts = dict(re.findall(r"^FACT (\S+) (.*)$", text, re.M))
        self.ended = re.search(r"^GUEST ended (\d+)", text, re.M)
        self.complaints = re.findall(r"^KERNEL (.*)$", text, re.M)
        self._json = {}
        for name, status, body in re.findall(r"^JSON (\S+) (\d+) ?(.*)$", text, re.M):
            try:
                self._json[name] = (int(status), json.loads(body) if body else None)
            except json.JSONDecodeError:
                self._json[name] = (int(status), None)

    def number(self, name):
        try:
            return float(self.facts[name])
        except (KeyError, ValueError):
            return None

    def status(self, name):
        return self._json.get(name, (None, None))[0]

    def get(self, name, *keys):
        """An entry of the JSON called `name`, reached by keys and indices."""
        value = self._json.get(name, (None, None))[1]
        for key in keys:
            try:
                value = value[key]
            except (KeyError, IndexError, TypeError):
                return None
        return value


class Verdict:
    """Figures for a person, and what was not as it must be."""

    def __init__(self):
        self.figures = []
        self.failures = []

    def _note(self, label, value, unit, holds, wanted):
        shown = "missing" if value is None else f"{round(value, 1):g}" if isinstance(value, float) else str(value)
        figure = f"{label} {shown}{unit}"
        self.figures.append(figure)
        if value is None or not holds(value):
            self.failures.append(f"{figure}, wanted {wanted}{unit}")

    def at_most(self, label, value, bound, unit=""):
        """Without a bound it is only shown, and must be there."""
        self._note(label, value, unit, lambda v: bound is None or v <= bound, "a figure" if bound is None else f"at most {bound}")

    def at_least(self, label, value, bound, unit=""):
        self._note(label, value, unit, lambda v: v >= bound, f"at least {bound}")

    def equal(self, label, value, wanted):
        self._note(label, value, "", lambda v: v == wanted, str(wanted))

    def silently(self, label, value, wanted):
        """As equal, without a figure where it holds."""
        if value != wanted:
            self.failures.append(f"{label} {value}, wanted {wanted}")

    def tell(self, text):
        self.figures.append(text)

    def tap(self, number, name):
        line = f"{'not ok' if self.failures else 'ok'} {number} - {name}: {', '.join(self.figures)}"
        return "\n".join([line.replace("#", "no. ")] + [f"# failed: {failure}" for failure in self.failures])


def us(ns):
    return None if ns is None else ns / 1000
