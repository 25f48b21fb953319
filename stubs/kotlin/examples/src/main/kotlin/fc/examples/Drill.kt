/**
 * An app for trying out a connection under trouble that somebody else makes: reads on while the connection is cut, gives calls up,
 * and calls on while the robot ends.
 */
@file:JvmName("Drill")

package fc.examples

import fc.Client
import fc.runtime.CallError
import java.util.concurrent.atomic.AtomicInteger
import kotlin.system.exitProcess
import kotlinx.coroutines.CoroutineStart
import kotlinx.coroutines.coroutineScope
import kotlinx.coroutines.launch
import kotlinx.coroutines.runBlocking

private const val USAGE = """Tries out the connection to a robot: reads while it is cut, gives calls up, calls while the robot ends.

Usage: run drill [--host 127.0.0.1] [--command-port PORT] [--gzip-from BYTES]

From `reading` on the connection may be cut; `calling` asks for the robot to be ended."""

/** Calls in flight at a time. */
private const val AT_ONCE = 64

/** Reads that are to be answered though the connection is cut. */
private const val READS = 1000

internal fun main(arguments: Array<String>) {
    val told = Arguments(arguments, USAGE)
    val fault = runBlocking {
        try {
            Client.connect(told.client()).use { client ->
                say("reading")
                read(client)
                say("read: $READS answered")
                giveUp(client)
                say("given up: $AT_ONCE, and the next one answered")
            }
            // Another one, which does not come back: that the robot has ended ends its calls.
            Client.connect(told.client().reconnect(null)).use { client ->
                say("calling")
                say("ended: ${callToTheEnd(client)} answered, $AT_ONCE lost")
            }
            null
        } catch (failure: Exception) {
            failure.message ?: failure.toString()
        }
    }
    if (fault != null) System.err.println(fault)
    exitProcess(if (fault == null) 0 else 1)
}

private fun say(line: String) {
    println(line)
    System.out.flush()
}

/** Each call is a read, so it is sent again after a loss, and every single one is answered. */
private suspend fun read(client: Client) {
    val left = AtomicInteger(READS)
    coroutineScope {
        repeat(AT_ONCE) {
            launch { while (left.getAndDecrement() > 0) client.getRobotSn() }
        }
    }
}

/** Sends calls and cancels them before an answer can have come; the connection serves on. */
private suspend fun giveUp(client: Client) {
    coroutineScope {
        // Each is sent before the next one begins.
        val calls = List(AT_ONCE) { launch(start = CoroutineStart.UNDISPATCHED) { client.getRobotSn() } }
        for (call in calls) call.cancel()
    }
    client.getRobotSn()
}

/**
 * Calls until the robot has gone, and tells how many were answered. Every call has an end, and the end of the last ones says that
 * the connection was lost.
 */
private suspend fun callToTheEnd(client: Client): Int {
    val answered = AtomicInteger()
    coroutineScope {
        repeat(AT_ONCE) {
            launch {
                try {
                    while (true) {
                        client.getRobotSn()
                        answered.incrementAndGet()
                    }
                } catch (error: CallError) {
                    if (error.loss == null) throw error
                }
            }
        }
    }
    return answered.get()
}
