"""The search of GrainLearning over the friction of a pile. We have not tested these lines."""
import grainfield as gf


def run_piles(calibration):
    proposed = calibration.system.param_data[:, 0]          # friction, one value a sample
    done = gf.sweep("pile-line-source", {"material.friction": proposed}, realizations=4, workers=2,
                    folder=f"repose/{calibration.curr_iter}")
    calibration.system.set_sim_data(done.table("repose.mean_deg")["repose.mean_deg"][:, None, None])
