package fc.runtime

import fc.Fc
import java.io.File

/** Of several faults in one body, that of `faults.json` is named, with the place where it is. */
internal fun faultTests(tests: Tests) {
    for (fault in Tree.of(File(tests.root, "conformance/faults.json"))["faults"].items) {
        tests.case(fault["name"].text, "faults") {
            val isRequest = fault["message"].text == "request"
            val error = runCatching {
                val read = Bodies.enveloped(
                    if (isRequest) Fc.requestEnvelope else Fc.responseEnvelope,
                    messageOf(fault["operation"].text, isRequest),
                    fault["text"].text.toByteArray(),
                    Fc.defaults.limits.json(),
                )
                read.fault?.let { throw it }
            }.exceptionOrNull() as BodyError?
            expect(fault["error"].text, error?.name) { "$error:" }
            fault.find("path")?.let { expect(it.text, error?.path) }
        }
    }
}

private fun messageOf(operation: String, isRequest: Boolean): MessageType<*> {
    Fc.commands.firstOrNull { it.name == operation }?.let { return if (isRequest) it.request else it.response }
    val report = Fc.reports.first { it.name == operation }
    return if (isRequest) report.message else report.acknowledgement
}
