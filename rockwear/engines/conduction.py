"""Heat in a network and nothing else."""
from rockwear.engines.base import Engine


class Conduction(Engine):
    """Heat in a network and nothing else: every visit lets the time since the last one pass.

    network: kernels.conduction.HeatNetwork; step: s, the longest heat step, at most the stable one.
    """

    name = "heat"

    def __init__(self, *, network, step, period=1):
        super().__init__(period=period)
        self.network, self.step = network, step

    def act(self):
        self.network.advance(self.elapsed(), step=self.step)

    def state(self):
        return {"network": self.network.state()}

    def restore(self, state):
        self.network.restore(state["network"])
