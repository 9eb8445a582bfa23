"""A row of the table."""


class Result:
    def __init__(self, kind):
        self.kind = kind
        self.accepted = False
        self.driven = ""
        self.detail = ""
        self.messages = []
        self.faults = []
        self.wrongs = []
        self.no_route = False

    def add(self, outcome):
        """Records the message of a refusal, or a fault: a crash, exit code 1, or a timeout."""
        if outcome.fault:
            self.faults.append(outcome.fault)
        if not outcome.accepted and outcome.message not in self.messages:
            self.messages.append(outcome.message)

    def note(self, text):
        if text not in self.messages:
            self.messages.append(text)

    def wrong(self, text):
        self.wrongs.append(text)
